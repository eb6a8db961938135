#pragma once
// Points of a disk for the soft shadows of round lights.

#include "meshing/patch_place.h"
#include "meshing/vec3.h"

#include <cmath>
#include <numbers>

namespace alvor {

/// Returns a point of the unit disk about the origin that is perpendicular to `axis` (unit), uniform by area for `at` uniform in
/// the unit square.
inline Vec3 disk_point(Vec3 axis, Uv at) {
  const Vec3 side = normalized(cross(axis, std::abs(axis.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0})), up = cross(axis, side);
  const double radius = std::sqrt(at.u), angle = 2 * std::numbers::pi * at.v;
  return radius * std::cos(angle) * side + radius * std::sin(angle) * up;
}

}  // namespace alvor
