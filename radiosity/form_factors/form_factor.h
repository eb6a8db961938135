#pragma once

#include "meshing/vec3.h"

#include <span>

namespace alvor {

/// Form factor from a differential surface at `point` with unit normal `normal` to a planar polygon, the part below the point's
/// horizon cut off, without regard to occlusion: F = 1/2pi sum over edges of angle times (edge plane normal . normal) (Lambert
/// 1760; Baum, Rushmeier & Winget 1989). In [0, 1]. 0 where the polygon shows its back (its front has the corners
/// counter-clockwise). Requires: 3 or 4 corners.
double point_to_polygon(Vec3 point, Vec3 normal, std::span<const Vec3> polygon);

/// The same for any number of corners, all of them above the horizon.
double point_to_polygon_above(Vec3 point, Vec3 normal, std::span<const Vec3> polygon);

}  // namespace alvor
