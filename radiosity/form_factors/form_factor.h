#pragma once

#include "meshing/vec3.h"

#include <span>

namespace alvor {

/// Returns the form factor, in [0, 1], from a differential surface at `point` with unit normal `normal` to the part of a planar
/// polygon above the point's horizon, without occlusion. F = 1/(2 pi) times the sum over edges of angle times (edge plane normal
/// . normal) (Lambert 1760; Baum, Rushmeier & Winget 1989). It is 0 if the polygon shows its back (its front has the corners
/// counter-clockwise). Requires: 3 or 4 corners.
double point_to_polygon(Vec3 point, Vec3 normal, std::span<const Vec3> polygon);

/// Returns the form factor from a differential surface, as point_to_polygon() does, to a polygon of any number of corners.
/// Requires: all corners lie above the horizon.
double point_to_polygon_above(Vec3 point, Vec3 normal, std::span<const Vec3> polygon);

}  // namespace alvor
