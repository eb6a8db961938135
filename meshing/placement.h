#pragma once

#include "meshing/vec3.h"

namespace alvor {

/// An affine map, given by the images of the axes and of the origin. The identity changes no bit of a point.
struct Placement {
  Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin;

  Vec3 direction(Vec3 d) const { return d.x * x + d.y * y + d.z * z; }
  Vec3 point(Vec3 p) const { return direction(p) + origin; }
  /// Returns whether the map turns counter-clockwise into clockwise.
  bool mirrors() const { return dot(cross(x, y), z) < 0; }

  friend bool operator==(const Placement&, const Placement&) = default;
};

/// Returns the map that applies `inner`, then `outer`.
inline Placement operator*(const Placement& outer, const Placement& inner) {
  return {outer.direction(inner.x), outer.direction(inner.y), outer.direction(inner.z), outer.point(inner.origin)};
}

}  // namespace alvor
