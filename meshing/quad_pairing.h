#pragma once
// Finds pairs of triangles that an exporter cut from one quad.

#include "meshing/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

struct PairableTriangle {
  std::array<std::uint32_t, 3> corners;  ///< welded vertices; triangles that share two share an edge
  std::uint32_t material = 0;
  std::uint32_t face = 0;  ///< number in the scene; consecutive triangles are likely to be one quad
};

struct TrianglePair {
  std::uint32_t first, second;           ///< indices of triangles, first < second
  std::array<std::uint32_t, 4> corners;  ///< corners of the quad, starting at the first triangle's first corner
};

/// Returns pairs of triangles of one material that share an edge, lie in one plane and have a strictly convex outline with
/// corners of 20 to 160 degrees. Consecutive triangles and square corners are preferred; each triangle is used at most once. O(n
/// log n). Requires: corners of a triangle differ and are indices of `positions`; faces ascend.
std::vector<TrianglePair> pair_triangles(std::span<const PairableTriangle> triangles, std::span<const Vec3> positions);

}  // namespace alvor
