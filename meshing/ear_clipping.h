#pragma once
// Cuts a polygon into triangles by ear clipping.

#include "meshing/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Returns the corner numbers of polygon.size() - 2 triangles. An ear is a convex corner whose triangle holds no other corner.
/// Each step cuts off the first ear after the first corner, so a convex polygon becomes the fan about its first corner, as in
/// most programs. A polygon that crosses itself is cut without regard to the overlap. `normal` is the unit normal; convex corners
/// turn left about it. Takes O(n log n) for polygons without long thin ears, by a tree of boxes over the corners.
std::vector<std::array<std::uint32_t, 3>> clip_ears(std::span<const Vec3> polygon, Vec3 normal);

}  // namespace alvor
