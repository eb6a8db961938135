#include "client/verify/facets.h"

#include "meshing/polygon.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr double line_area = 1e-14;  ///< fraction of the longest side squared, below which a triangle is a line

double longest_side(const std::array<Vec3, 3>& corners) {
  return std::max({length(corners[1] - corners[0]), length(corners[2] - corners[1]), length(corners[0] - corners[2])});
}

/// Appends a triangle, unless it has no area.
void add_triangle(std::vector<Facet>& facets, Facet facet) {
  const auto& corners = facet.corners;
  const Vec3 doubled = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double longest = longest_side(corners);
  facet.area = 0.5 * length(doubled);
  if (!(facet.area > line_area * longest * longest)) return;
  facet.normal = normalized(doubled);
  facets.push_back(facet);
}

void add_face(std::vector<Facet>& facets, const Scene& scene, std::uint32_t face) {
  std::vector<Vec3> polygon;
  for (const std::uint32_t corner : scene.corners_of(scene.faces[face])) polygon.push_back(scene.vertices[corner]);
  const auto points = scene.texture_points_of(scene.faces[face]);
  const auto colours = scene.colours_of(scene.faces[face]);
  const auto add = [&](const std::array<std::uint32_t, 3>& corners) {
    Facet facet{.face = face};
    for (std::size_t c = 0; c < 3; ++c) {
      facet.corners[c] = polygon[corners[c]];
      if (!points.empty()) facet.texture_points[c] = points[corners[c]];
      if (!colours.empty()) facet.colours[c] = colours[corners[c]];
    }
    add_triangle(facets, facet);
  };
  for (const auto& [a, b, c, d] : pieces_of(polygon)) {
    add({a, b, c});
    if (d != no_corner) add({a, c, d});
  }
}

}  // namespace

std::vector<Facet> facets_of(const Scene& scene) {
  std::vector<Facet> facets;
  for (std::uint32_t face = 0; face < scene.faces.size(); ++face) add_face(facets, scene, face);
  return facets;
}

Extent extent_of(std::span<const Vec3> points) {
  if (points.empty()) return {};
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
