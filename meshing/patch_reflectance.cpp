#include "meshing/patch_reflectance.h"

#include "meshing/polygon.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <unordered_set>
#include <vector>

namespace alvor {

namespace {

// Share of a patch below which its part on one side of the diagonal is rounding.
constexpr double sliver = 1e-9;

/// What is given at the corners of a root patch, on its two triangles: (0, 1, 2), where a >= 0, and of a quad (0, 2, 3), where a
/// <= 0.
class TwoTriangles {
 public:
  explicit TwoTriangles(const RootPatch& root) : root_(root) {
    if (root.corner_count == 4) fourth_ = at(root.corners[3]);
  }

  PlanePoint at(Vec3 p) const {
    const auto weight = barycentric(p, root_.corners[0], root_.corners[1], root_.corners[2]);
    return {weight[1], weight[2]};
  }
  bool is_in_second(PlanePoint p) const { return root_.corner_count == 4 && p.a < 0; }

  /// Returns the weights of the corners at a place.
  std::array<double, 4> weights(PlanePoint p, bool is_second) const {
    if (!is_second) return {1 - p.a - p.b, p.a, p.b, 0};
    const double last = p.a / fourth_.a, third = p.b - last * fourth_.b;
    return {1 - third - last, 0, third, last};
  }

 private:
  const RootPatch& root_;
  PlanePoint fourth_{-1, 1};
};

TexelPoint texel_at(const std::array<TexturePoint, 4>& points, const std::array<double, 4>& weight, const ColourImage& image) {
  TexelPoint sum;
  for (std::size_t c = 0; c < 4; ++c) sum.x += weight[c] * double{points[c].s}, sum.y += weight[c] * double{points[c].t};
  return {sum.x * image.columns, sum.y * image.rows};
}

Rgb mixed(const std::array<RgbF, 4>& colours, const std::array<double, 4>& weight) {
  Rgb sum;
  for (std::size_t c = 0; c < 4; ++c) sum += weight[c] * widen(colours[c]);
  return sum;
}

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
    twice += (p.a - polygon[0].a) * (q.b - polygon[0].b) - (q.a - polygon[0].a) * (p.b - polygon[0].b);
  }
  return std::abs(twice) / 2;
}

/// Returns the centroid of a convex polygon, at which a linear function has its mean. Requires: it has an area.
PlanePoint centroid_of(const std::vector<PlanePoint>& polygon) {
  PlanePoint sum;
  double twice = 0;
  const PlanePoint o = polygon[0];
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k) {
    const PlanePoint p = polygon[k], q = polygon[k + 1];
    const double area = (p.a - o.a) * (q.b - o.b) - (q.a - o.a) * (p.b - o.b);
    sum.a += area * (o.a + p.a + q.a) / 3, sum.b += area * (o.b + p.b + q.b) / 3;
    twice += area;
  }
  return {sum.a / twice, sum.b / twice};
}

}  // namespace

/// How a triangle of a root lies on an image, in texels. Triangles that lie on a line of the image are drawn apart by a hundredth
/// of a texel, so that each texel keeps its share of the triangle.
class PatchReflectance::TextureMap {
 public:
  TextureMap(const BaseMesh& mesh, std::uint32_t root, const TwoTriangles& triangles, bool is_second) {
    const ColourImage& image = *mesh.material_of(root).texture->image;
    const auto texel = [&](PlanePoint p) { return texel_at(mesh.texture_points(root), triangles.weights(p, is_second), image); };
    origin_ = texel({0, 0});
    const TexelPoint a = texel({1, 0}), b = texel({0, 1});
    along_a_ = {a.x - origin_.x, a.y - origin_.y}, along_b_ = {b.x - origin_.x, b.y - origin_.y};
    const double size_a = std::hypot(along_a_.x, along_a_.y), size_b = std::hypot(along_b_.x, along_b_.y);
    constexpr double one_point = 1e-6;
    is_point_ = std::max(size_a, size_b) < one_point;
    if (!is_point_ && std::abs(along_a_.x * along_b_.y - along_a_.y * along_b_.x) < apart * std::max(size_a, size_b))
      draw_apart(size_a > size_b ? along_a_ : along_b_);
  }

  bool is_point() const { return is_point_; }
  TexelPoint at(PlanePoint p) const {
    return {origin_.x + p.a * along_a_.x + p.b * along_b_.x, origin_.y + p.a * along_a_.y + p.b * along_b_.y};
  }

 private:
  static constexpr double apart = 1e-2;  // texels

  /// Puts points on the line of this direction, and moves them across it by where they lie in the direction of the plane that the
  /// image does not show.
  void draw_apart(TexelPoint line) {
    const double size = std::hypot(line.x, line.y);
    const TexelPoint unit{line.x / size, line.y / size}, across{-unit.y, unit.x};
    const double a = along_a_.x * unit.x + along_a_.y * unit.y, b = along_b_.x * unit.x + along_b_.y * unit.y;
    const double off_a = -apart * b / std::hypot(a, b), off_b = apart * a / std::hypot(a, b);
    along_a_ = {a * unit.x + off_a * across.x, a * unit.y + off_a * across.y};
    along_b_ = {b * unit.x + off_b * across.x, b * unit.y + off_b * across.y};
  }

  TexelPoint origin_, along_a_, along_b_;
  bool is_point_ = false;
};

TexturePoint texture_point_at(const BaseMesh& mesh, std::uint32_t root, Uv at) {
  const TwoTriangles triangles(mesh.roots()[root]);
  const PlanePoint p = triangles.at(mesh.roots()[root].at(at.u, at.v));
  const auto weight = triangles.weights(p, triangles.is_in_second(p));
  const auto& points = mesh.texture_points(root);
  double s = 0, t = 0;
  for (std::size_t c = 0; c < 4; ++c) s += weight[c] * double{points[c].s}, t += weight[c] * double{points[c].t};
  return {static_cast<float>(s), static_cast<float>(t)};
}

double opacity_at(const BaseMesh& mesh, std::uint32_t root, Uv at) {
  const Material& material = mesh.material_of(root);
  return material.has_cutout() ? material.texture->opacity_at(texture_point_at(mesh, root, at)) : 1;
}

Rgb colour_at(const BaseMesh& mesh, std::uint32_t root, Uv at) {
  const TwoTriangles triangles(mesh.roots()[root]);
  const PlanePoint p = triangles.at(mesh.roots()[root].at(at.u, at.v));
  return mixed(mesh.corner_colours(root), triangles.weights(p, triangles.is_in_second(p)));
}

std::size_t PatchReflectance::bytes_for(const BaseMesh& mesh) {
  std::unordered_set<const ColourImage*> images;
  std::size_t bytes = 0;
  for (const Material& material : mesh.materials())
    if (material.texture && images.insert(material.texture->image.get()).second)
      bytes += TextureMean::bytes_for(*material.texture->image);
  return bytes;
}

PatchReflectance::PatchReflectance(const BaseMesh& mesh) : mesh_(mesh) {
  for (const RootPatch& root : mesh.roots())
    if (const auto& texture = mesh.materials()[root.material].texture) means_.try_emplace(texture->image.get(), *texture->image);
}

bool PatchReflectance::varies(std::uint32_t root) const {
  if (mesh_.material_of(root).texture) return true;
  if (!mesh_.has_colours()) return false;
  const auto& colours = mesh_.corner_colours(root);
  return std::ranges::any_of(std::span(colours).first(static_cast<std::size_t>(mesh_.roots()[root].corner_count)),
                             [&](const RgbF& colour) { return colour != colours[0]; });
}

/// Returns the mean of the texture over a part of a root, on one side of the diagonal.
MeanSurface PatchReflectance::of_part(std::uint32_t root, const TextureMap& map, std::span<const PlanePoint> part) const {
  const Texture& texture = *mesh_.material_of(root).texture;
  if (map.is_point()) {
    const TexturePoint point = mesh_.texture_points(root)[0];
    return {texture.reflectance_at(point), texture.opacity_at(point)};
  }
  std::vector<TexelPoint> texels;
  for (const PlanePoint& p : part) texels.push_back(map.at(p));
  const MeanSurface mean = means_.at(texture.image.get()).over(texels, texture.wrap_s, texture.wrap_t);
  return {texture.factor * mean.reflectance, mean.cover};
}

MeanSurface PatchReflectance::of(const PatchShape& shape) const {
  const Material& material = mesh_.material_of(shape.root);
  if (!material.texture && !mesh_.has_colours()) return {material.reflectance};
  const TwoTriangles triangles(mesh_.roots()[shape.root]);
  const auto corners = corners_of(mesh_, shape);
  std::vector<PlanePoint> patch;
  for (int c = 0; c < shape.corner_count; ++c) patch.push_back(triangles.at(corners[c]));
  Rgb sum;
  double area = 0, covered = 0;
  for (const bool is_second : {false, true}) {
    if (is_second && shape.corner_count == 3) break;
    const std::vector<PlanePoint> part = shape.corner_count == 4 ? part_of(patch, is_second) : patch;
    const double share = area_of(part);
    if (!(share > sliver * area_of(patch))) continue;
    MeanSurface mean{material.reflectance};
    if (material.texture) mean = of_part(shape.root, TextureMap(mesh_, shape.root, triangles, is_second), part);
    if (mesh_.has_colours())
      mean.reflectance =
          mean.reflectance * mixed(mesh_.corner_colours(shape.root), triangles.weights(centroid_of(part), is_second));
    sum += share * mean.cover * mean.reflectance;
    covered += share * mean.cover;
    area += share;
  }
  if (area == 0) return {material.reflectance};
  return {covered > 0 ? sum * (1 / covered) : Rgb{}, covered / area};
}

}  // namespace alvor
