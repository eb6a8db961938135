#pragma once

#include "client/verify/path_random.h"
#include "meshing/vec3.h"

namespace alvor {

/// Returns a direction about a unit normal, for `at` uniform in the unit square. Its density is the cosine over pi (Nusselt's
/// analogy). The frame is made without branches (Duff et al. 2017).
Vec3 cosine_direction(Vec3 normal, UnitPair at);

/// Returns a direction that is uniform on the unit sphere, for `at` uniform in the unit square.
Vec3 uniform_direction(UnitPair at);

}  // namespace alvor
