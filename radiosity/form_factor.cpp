#include "radiosity/form_factor.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace alvor {

namespace {

/// A polygon of up to four corners has at most five above a plane.
struct ClippedPolygon {
  std::array<Vec3, 5> corner;
  int count = 0;
  void add(Vec3 p) { corner[count++] = p; }
};

/// Corners relative to the point; keeps what lies above the horizon.
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

}  // namespace

double point_to_polygon(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  const ClippedPolygon seen = above_horizon(point, normal, polygon);
  double sum = 0;
  for (int c = 0; c < seen.count; ++c) {
    const Vec3 a = seen.corner[c], b = seen.corner[c + 1 == seen.count ? 0 : c + 1];
    const Vec3 edge_normal = cross(b, a);
    const double sine = length(edge_normal);
    if (sine > 0) sum += std::atan2(sine, dot(a, b)) * dot(edge_normal, normal) / sine;
  }
  return std::clamp(sum / (2 * std::numbers::pi), 0.0, 1.0);
}

}  // namespace alvor
