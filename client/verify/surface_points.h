#pragma once
// Where a solution is verified.

#include "client/verify/path_tracer.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// Independent points, uniform by area over all fronts, and over both sides of what is two-sided. Requires: !find_fault(scene),
/// and at least one face with area.
std::vector<SurfacePoint> draw_surface_points(const Scene& scene, std::size_t count, std::uint64_t seed);

}  // namespace alvor
