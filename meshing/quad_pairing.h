#pragma once
// Exporters cut quads in two; this finds which triangles were one quad.

#include "meshing/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

struct PairableTriangle {
  std::array<std::uint32_t, 3> corners;  ///< welded vertices: triangles share an edge where they share two of these
  std::uint32_t material = 0;
  std::uint32_t face = 0;  ///< its number in the scene: triangles that follow each other are likely to be one quad
};

struct TrianglePair {
  std::uint32_t first, second;           ///< indices of triangles, first < second
  std::array<std::uint32_t, 4> corners;  ///< of the quad, from the first triangle's first corner on
};

/// Chooses pairs of triangles of one material that share an edge, lie in one plane and make a strictly convex outline with
/// corners of 20 to 160 degrees. Consecutive triangles and square corners are preferred; each triangle is used once at most. O(n
/// log n). Requires: corners of a triangle differ and are indices of `positions`; faces ascend.
std::vector<TrianglePair> pair_triangles(std::span<const PairableTriangle> triangles, std::span<const Vec3> positions);

}  // namespace alvor
