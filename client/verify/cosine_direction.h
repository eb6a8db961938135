#pragma once

#include "client/verify/path_random.h"
#include "meshing/vec3.h"

namespace alvor {

/// Returns a direction about a unit normal whose density is the cosine over pi (Nusselt's analogy), for `at` uniform in the unit
/// square; in a frame without branches (Duff et al. 2017).
Vec3 cosine_direction(Vec3 normal, UnitPair at);

/// Returns a direction uniform on the unit sphere.
Vec3 uniform_direction(UnitPair at);

}  // namespace alvor
