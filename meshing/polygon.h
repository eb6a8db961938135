#pragma once
// A polygon becomes triangles and planar convex quads.

#include "meshing/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Twice the area vector of the polygon (Newell's method): right for any planar polygon, least squares for others.
Vec3 double_area_vector(std::span<const Vec3> polygon);

/// Corner numbers of each piece; the fourth is `no_corner` for a triangle.
using Piece = std::array<std::uint32_t, 4>;
inline constexpr std::uint32_t no_corner = ~0u;

/// A triangle, or a convex quad planar to 4e-6 of its size, stays whole; anything else is cut into triangles (clip_ears).
std::vector<Piece> pieces_of(std::span<const Vec3> polygon);

}  // namespace alvor
