#pragma once
// How near the surfaces are that a patch sees.

#include "meshing/patch_place.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/transport_rows.h"

#include <cstdint>

namespace alvor {

/// Rays that near_distance() sends.
inline constexpr std::uint64_t rays_to_near_surfaces = 16;

/// Returns the harmonic mean of the distances, in metres, at which sixteen cosine-distributed rays from the centre of a patch
/// meet a surface; infinite if none does. Reflected light varies little over distances that are small beside this mean (Ward,
/// Rubinstein & Clear 1988). It depends on the patch and the seed alone.
double near_distance(const LocalScene& scene, const PatchShape& patch, PatchId id, std::uint64_t seed);

/// Returns the height above the plane of a root, in metres, below which half of a row's rays end: the width of the gap that the
/// row is in, if it is in one. Infinite where half of them leave the scene, go on through panes or meet backs, and for exact
/// rows. `centre` is that of the row's patch.
double gap_before(const BaseMesh& mesh, std::uint32_t root, Vec3 centre, const TransportRow& row);

}  // namespace alvor
