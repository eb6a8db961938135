#pragma once
// Points of a disk for the soft shadows of round lights.

#include "meshing/patch_place.h"
#include "meshing/tangent_frame.h"

#include <cmath>
#include <numbers>

namespace alvor {

/// Returns a point of the unit disk about the origin in the plane of `axes`, uniform by area for `at` uniform in the unit square.
inline Vec3 disk_point(const TangentFrame& axes, Uv at) {
  const double radius = std::sqrt(at.u), angle = 2 * std::numbers::pi * at.v;
  return radius * std::cos(angle) * axes.s + radius * std::sin(angle) * axes.t;
}

}  // namespace alvor
