#pragma once
// Sample points of a patch, in local coordinates.

#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/sampling.h"

namespace alvor {

/// Distance of a ray's start from its surface, along the normal, in local units (the scene's longest side is 1). It is some 67
/// times the spacing of float32 at coordinate 1/2 (3e-8), so that rounding cannot put a start behind its surface. Chosen; half:
/// the same, double: error -1 %, rays same (docs/design/constants.md).
inline constexpr float ray_offset = 2e-6f;

/// The sixteen sample points (origins) of a patch, one in each grandchild, in local units.
struct alignas(64) PatchPoints {
  float x[origins_per_patch], y[origins_per_patch], z[origins_per_patch];
};

/// Returns the sample points of a patch. Draws two numbers from `random`: all strata share one jitter (see origins_in). A fresh
/// RandomStream of the patch gives transport rows and direct light the same points, so that an origin that the row found hidden
/// is hidden for direct light too.
PatchPoints sample_points(const LocalScene& scene, const PatchShape& patch, RandomStream& random);

}  // namespace alvor
