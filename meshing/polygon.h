#pragma once
// Cuts polygons into triangles and planar convex quads.

#include "meshing/vec3.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Returns twice the area vector of the polygon (Newell's method). Exact for planar polygons, a least-squares fit for others.
Vec3 double_area_vector(std::span<const Vec3> polygon);

/// Returns the weights of the corners a, b and c of a triangle whose sum is a point in its plane. Requires: the triangle has an
/// area.
std::array<double, 3> barycentric(Vec3 point, Vec3 a, Vec3 b, Vec3 c);

/// The corner numbers of a triangle or quad cut from a polygon; the fourth is `no_corner` for a triangle.
using Piece = std::array<std::uint32_t, 4>;
inline constexpr std::uint32_t no_corner = ~0u;

/// Returns the pieces of a polygon. A triangle stays whole, and so does a convex quad that is planar to 4e-6 of its size; every
/// other polygon is cut into triangles (clip_ears).
std::vector<Piece> pieces_of(std::span<const Vec3> polygon);

}  // namespace alvor
