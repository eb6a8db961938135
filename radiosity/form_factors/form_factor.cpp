#include "radiosity/form_factors/form_factor.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numbers>

namespace alvor {

namespace {

/// The part of a polygon of up to four corners above a horizon. It has at most five corners; six if the polygon is seen edge on,
/// where rounding bends it.
struct ClippedPolygon {
  std::array<Vec3, 6> corner;
  int count = 0;
  void add(Vec3 p) { corner[count++] = p; }
};

/// Returns the part of the polygon above the point's horizon, with corners relative to the point.
ClippedPolygon above_horizon(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  ClippedPolygon kept;
  Vec3 before = polygon.back() - point;
  double height_before = dot(before, normal);
  for (const Vec3& corner : polygon) {
    const Vec3 here = corner - point;
    const double height = dot(here, normal);
    if ((height > 0) != (height_before > 0)) kept.add(lerp(before, here, height_before / (height_before - height)));
    if (height > 0) kept.add(here);
    before = here;
    height_before = height;
  }
  return kept;
}

/// Returns Lambert's sum over the edges of a polygon, clamped to [0, 1].
double lambert_sum(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  if (polygon.empty()) return 0;
  double sum = 0;
  Vec3 a = polygon.back() - point;
  for (const Vec3& corner : polygon) {
    const Vec3 b = corner - point, edge_normal = cross(b, a);
    const double sine = length(edge_normal);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(edge_normal, normal) / sine;
    a = b;
  }
  return std::clamp(sum / (2 * std::numbers::pi), 0.0, 1.0);
}

}  // namespace

double point_to_polygon(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  assert(polygon.size() == 3 || polygon.size() == 4);
  const ClippedPolygon seen = above_horizon(point, normal, polygon);
  return lambert_sum({}, normal, {seen.corner.data(), static_cast<std::size_t>(seen.count)});
}

double point_to_polygon_above(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  return lambert_sum(point, normal, polygon);
}

}  // namespace alvor
