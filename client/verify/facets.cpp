#include "client/verify/facets.h"

#include "meshing/polygon.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr double line_area = 1e-14;  ///< fraction of the longest side squared, below which a triangle is a line

double longest_side(const std::array<Vec3, 3>& corners) {
  return std::max({length(corners[1] - corners[0]), length(corners[2] - corners[1]), length(corners[0] - corners[2])});
}

void add_triangle(std::vector<Facet>& facets, const std::array<Vec3, 3>& corners, std::uint32_t face,
                  const std::array<TexturePoint, 3>& points) {
  const Vec3 doubled = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double longest = longest_side(corners), area = 0.5 * length(doubled);
  if (!(area > line_area * longest * longest)) return;
  facets.push_back({corners, normalized(doubled), area, face, points});
}

void add_face(std::vector<Facet>& facets, const Scene& scene, std::uint32_t face) {
  std::vector<Vec3> polygon;
  for (const std::uint32_t corner : scene.corners_of(scene.faces[face])) polygon.push_back(scene.vertices[corner]);
  const auto points = scene.texture_points_of(scene.faces[face]);
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    std::array<TexturePoint, 3> at;
    if (!points.empty()) at = {points[a], points[b], points[c]};
    add_triangle(facets, {polygon[a], polygon[b], polygon[c]}, face, at);
  };
  for (const auto& [a, b, c, d] : pieces_of(polygon)) {
    add(a, b, c);
    if (d != no_corner) add(a, c, d);
  }
}

}  // namespace

std::vector<Facet> facets_of(const Scene& scene) {
  std::vector<Facet> facets;
  for (std::uint32_t face = 0; face < scene.faces.size(); ++face) add_face(facets, scene, face);
  return facets;
}

Extent extent_of(std::span<const Vec3> points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& p : points) {
    low = lower(low, p);
    high = upper(high, p);
  }
  return {lerp(low, high, 0.5), std::max({high.x - low.x, high.y - low.y, high.z - low.z})};
}

Extent extent_of(std::span<const Facet> facets) {
  std::vector<Vec3> corners;
  for (const Facet& facet : facets) corners.insert(corners.end(), facet.corners.begin(), facet.corners.end());
  return extent_of(std::span<const Vec3>(corners));
}

}  // namespace alvor
