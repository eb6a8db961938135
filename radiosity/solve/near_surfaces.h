#pragma once
// How near the surfaces are that a patch sees.

#include "meshing/patch_place.h"
#include "radiosity/rays/local_scene.h"

#include <cstdint>

namespace alvor {

/// Rays that near_distance() sends.
inline constexpr std::uint64_t rays_to_near_surfaces = 16;

/// Returns the harmonic mean of the distances, in metres, at which sixteen cosine-distributed rays from the centre of a patch
/// meet a surface; infinite if none does. Reflected light varies little over distances that are small beside this mean (Ward,
/// Rubinstein & Clear 1988). It depends on the patch and the seed alone.
double near_distance(const LocalScene& scene, const PatchShape& patch, PatchId id, std::uint64_t seed);

}  // namespace alvor
