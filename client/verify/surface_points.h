#pragma once
// Draws the random points at which a solution is verified.

#include "client/verify/path_tracer.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// Returns independent points, uniform by area over all fronts, and over both sides of two-sided faces. Requires:
/// !find_fault(scene), and at least one face with area.
std::vector<SurfacePoint> draw_surface_points(const Scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace alvor
