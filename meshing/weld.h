#pragma once

#include "meshing/vec3.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Which earlier vertex each vertex coincides with, within `tolerance` in each coordinate; itself if none. Expected linear time.
std::vector<std::uint32_t> weld(std::span<const Vec3> vertices, double tolerance);

}  // namespace alvor
