#pragma once
// A rectangle in space.

#include "meshing/patch_place.h"
#include "meshing/vec3.h"

#include <array>
#include <optional>

namespace alvor {

/// A rectangle in local units (see LocalFrame).
struct FlatRectangle {
  Vec3 corner, side_u, side_v;  ///< the sides are perpendicular to each other
  Vec3 normal;                  ///< unit
  Vec3 at(double u, double v) const { return corner + u * side_u + v * side_v; }
  std::array<Vec3, 4> corners() const { return {corner, corner + side_u, corner + side_u + side_v, corner + side_v}; }
  double area() const { return length(side_u) * length(side_v); }
  /// Returns where a ray crosses the rectangle, in shares of its sides, from either side; nothing if it does not, or if it starts
  /// on it. Requires: the sides are not zero.
  std::optional<Uv> crossing(Vec3 from, Vec3 direction) const {
    const double approach = dot(direction, normal), height = dot(corner - from, normal);
    // Both have one sign where the ray goes towards the rectangle's plane.
    if (height * approach <= starts_on * std::abs(approach)) return {};
    const Vec3 place = from + height / approach * direction - corner;
    const double u = dot(place, side_u) / dot(side_u, side_u), v = dot(place, side_v) / dot(side_v, side_v);
    if (!(u >= 0 && u <= 1 && v >= 0 && v <= 1)) return {};
    return Uv{u, v};
  }
  FlatRectangle part(double low_u, double high_u, double low_v, double high_v) const {
    return {at(low_u, low_v), (high_u - low_u) * side_u, (high_v - low_v) * side_v, normal};
  }

 private:
  // Distance from the plane within which a ray starts on it: some roundings of float32.
  static constexpr double starts_on = 1e-5;
};

}  // namespace alvor
