#pragma once
// Coordinates of a floor plan.

#include "meshing/display_mesh.h"
#include "meshing/scene.h"
#include "meshing/vec3.h"

namespace alvor {

/// The axes of a plan seen from above: `u` to the right, `v` up the sheet, `up` towards the reader. Unit vectors, right-handed.
struct PlanFrame {
  Vec3 u{1, 0, 0}, v{0, 0, -1}, up{0, 1, 0};

  Vec3 place(double along_u, double along_v, double height) const { return along_u * u + along_v * v + height * up; }
};

/// Returns the frame whose u is the x axis, turned about the vertical by an angle in radians, counter-clockwise seen from above.
inline PlanFrame plan_frame(UpAxis axis, double turn) {
  const Vec3 up = axis == UpAxis::y ? Vec3{0, 1, 0} : Vec3{0, 0, 1}, x{1, 0, 0}, y = cross(up, x);
  const Vec3 u = std::cos(turn) * x + std::sin(turn) * y;
  return {u, cross(up, u), up};
}

/// Returns the frame along whose axes most walls stand.
PlanFrame frame_along_walls(const DisplayMesh& mesh);

}  // namespace alvor
