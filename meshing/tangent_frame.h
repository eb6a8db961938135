#pragma once

#include "meshing/vec3.h"

#include <cmath>

namespace alvor {

/// Two unit axes s and t perpendicular to a unit normal; s, t and the normal are right-handed.
struct TangentFrame {
  Vec3 s, t;
  explicit TangentFrame(Vec3 normal) {
    const Vec3 axis = std::abs(normal.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    s = normalized(cross(axis, normal));
    t = cross(normal, s);
  }
};

}  // namespace alvor
