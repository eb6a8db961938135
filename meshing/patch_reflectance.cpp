#include "meshing/patch_reflectance.h"

#include "meshing/polygon.h"

#include <array>
#include <cmath>
#include <vector>

namespace alvor {

namespace {

/// A place in the plane of a root patch: corner 0 + a (corner 1 - corner 0) + b (corner 2 - corner 0).
struct PlanePoint {
  double a = 0, b = 0;
};

/// The two triangles of a root patch on its texture: (0, 1, 2), where a >= 0, and of a quad (0, 2, 3), where a <= 0.
class TexturedRoot {
 public:
  TexturedRoot(const BaseMesh& mesh, std::uint32_t root)
      : root_(mesh.roots()[root]), points_(mesh.texture_points(root)), image_(*mesh.material_of(root).texture->image) {
    if (root_.corner_count == 4) fourth_ = at(root_.corners[3]);
  }

  PlanePoint at(Vec3 p) const {
    const auto weight = barycentric(p, root_.corners[0], root_.corners[1], root_.corners[2]);
    return {weight[1], weight[2]};
  }

  /// Returns the place on the image, in texels.
  TexelPoint texel_at(PlanePoint p, bool is_second) const {
    const double d = is_second ? p.a / fourth_.a : 0, a = is_second ? 0 : p.a, b = is_second ? p.b - d * fourth_.b : p.b;
    const auto mixed = [&](float TexturePoint::*axis) {
      const double origin = points_[0].*axis;
      return origin + a * (points_[1].*axis - origin) + b * (points_[2].*axis - origin) + d * (points_[3].*axis - origin);
    };
    return {mixed(&TexturePoint::s) * image_.columns, mixed(&TexturePoint::t) * image_.rows};
  }

 private:
  const RootPatch& root_;
  const std::array<TexturePoint, 4>& points_;
  const ColourImage& image_;
  PlanePoint fourth_{-1, 1};
};

/// Returns the part of a polygon on one side of the line a = 0.
std::vector<PlanePoint> part_of(const std::vector<PlanePoint>& polygon, bool is_second) {
  std::vector<PlanePoint> part;
  const double side = is_second ? -1 : 1;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint p = polygon[k], q = polygon[(k + 1) % polygon.size()];
    if (side * p.a >= 0) part.push_back(p);
    if (p.a * q.a < 0) part.push_back({0, p.b + p.a / (p.a - q.a) * (q.b - p.b)});
  }
  return part;
}

double area_of(const std::vector<PlanePoint>& polygon) {
  double twice = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const PlanePoint p = polygon[k], q = polygon[(k + 1) % polygon.size()];
    twice += p.a * q.b - q.a * p.b;
  }
  return std::abs(twice) / 2;
}

}  // namespace

TexturePoint texture_point_at(const BaseMesh& mesh, std::uint32_t root, Uv at) {
  const TexturedRoot textured(mesh, root);
  const PlanePoint p = textured.at(mesh.roots()[root].at(at.u, at.v));
  const TexelPoint texel = textured.texel_at(p, mesh.roots()[root].corner_count == 4 && p.a < 0);
  const ColourImage& image = *mesh.material_of(root).texture->image;
  return {static_cast<float>(texel.x / image.columns), static_cast<float>(texel.y / image.rows)};
}

PatchReflectance::PatchReflectance(const BaseMesh& mesh) : mesh_(mesh) {
  for (const RootPatch& root : mesh.roots())
    if (const auto& texture = mesh.materials()[root.material].texture) means_.try_emplace(texture->image.get(), *texture->image);
}

Rgb PatchReflectance::of(const PatchShape& shape) const {
  const Material& material = mesh_.material_of(shape.root);
  if (!material.texture) return material.reflectance;
  const TexturedRoot root(mesh_, shape.root);
  const auto corners = corners_of(mesh_, shape);
  std::vector<PlanePoint> patch;
  for (int c = 0; c < shape.corner_count; ++c) patch.push_back(root.at(corners[c]));
  Rgb sum;
  double area = 0;
  for (const bool is_second : {false, true}) {
    if (is_second && shape.corner_count == 3) break;
    const std::vector<PlanePoint> part = shape.corner_count == 4 ? part_of(patch, is_second) : patch;
    const double share = area_of(part);
    if (!(share > 0)) continue;
    std::vector<TexelPoint> texels;
    for (const PlanePoint& p : part) texels.push_back(root.texel_at(p, is_second));
    sum += share * means_.at(material.texture->image.get()).over(texels, material.texture->wrap_s, material.texture->wrap_t);
    area += share;
  }
  return area > 0 ? material.texture->factor * sum * (1 / area) : material.reflectance;
}

}  // namespace alvor
