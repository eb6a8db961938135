#pragma once

#include "meshing/display_mesh.h"

#include <cstdint>

namespace alvor {

/// Returns twice the area vector of a triangle, m2; it points to the front.
inline Vec3 double_area_of(const DisplayMesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
}

/// Returns the area of a triangle, m2.
inline double area_of(const DisplayMesh& mesh, std::uint32_t triangle) { return length(double_area_of(mesh, triangle)) / 2; }

}  // namespace alvor
