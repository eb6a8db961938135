#pragma once

#include "meshing/vec3.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Returns for each vertex the earlier vertex that coincides with it, within `tolerance` in each coordinate, or the vertex
/// itself. Expected linear time.
std::vector<std::uint32_t> weld(std::span<const Vec3> vertices, double tolerance);

}  // namespace alvor
