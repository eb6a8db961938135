#pragma once
// Helpers for tests that inspect faces of a scene.

#include "meshing/scene.h"

#include <cstdint>
#include <vector>

namespace alvor {

inline std::vector<std::uint32_t> corner_counts(const Scene& scene) {
  std::vector<std::uint32_t> counts;
  for (const Face& face : scene.faces) counts.push_back(face.corner_count);
  return counts;
}

inline Vec3 corner(const Scene& scene, std::size_t face, std::size_t k) {
  return scene.vertices[scene.corners_of(scene.faces[face])[k]];
}

/// Returns area times normal of a planar polygon.
inline Vec3 area_vector(const Scene& scene, std::size_t face) {
  Vec3 sum;
  for (std::size_t k = 2; k < scene.faces[face].corner_count; ++k)
    sum += 0.5 * cross(corner(scene, face, k - 1) - corner(scene, face, 0), corner(scene, face, k) - corner(scene, face, 0));
  return sum;
}

}  // namespace alvor
