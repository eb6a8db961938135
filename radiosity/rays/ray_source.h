#pragma once
// Sample points of a patch, in local coordinates.

#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/sampling.h"

namespace alvor {

/// Rays start this far in front of their surface, in local units, so that rounding cannot put them behind it.
inline constexpr float ray_offset = 2e-6f;

/// The sixteen sample points of a patch: one in each grandchild.
struct alignas(64) PatchPoints {
  float x[origins_per_patch], y[origins_per_patch], z[origins_per_patch];
};

/// Draws two numbers from `random`: all strata share one jitter (see origins_in). A stream used for nothing before gives a patch
/// the same points whatever they are for, so what a row learned of an origin holds for direct light too.
PatchPoints sample_points(const LocalScene& scene, const PatchShape& patch, RandomStream& random);

}  // namespace alvor
