#pragma once
// Transport rows: the stored sampling of a receiver's hemisphere.

#include "radiosity/local_scene.h"
#include "radiosity/ray_budget.h"
#include "radiosity/sampling.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Where the rays of one patch ended. Hits are places, so they survive later splits. The two halves are from disjoint sets of
/// origins, and their difference tells the row's sampling noise. Rays that left the scene or met a black back are counted but not
/// stored: each hit weighs 1 / ray_count(), times hit_weight.
struct TransportRow {
  std::vector<PatchId> hits;  ///< the first half's, then the second half's
  /// Of each hit, where hits do not all weigh the same: a hemicube cell's share, what a medium lets through. Empty: all 1.
  std::vector<RgbF> hit_weight;
  std::uint32_t first_half_hits = 0;
  std::uint32_t first_half_rays = 0, second_half_rays = 0;
  std::uint16_t hidden_origins = 0;  ///< bit o: origin o is hidden, see trace_rows

  std::uint32_t ray_count() const { return first_half_rays + second_half_rays; }
  bool is_hidden() const { return ray_count() == 0; }
  /// The outline of a solid that stands on the patch runs through it.
  bool crosses_contact() const { return hidden_origins != 0 && !is_hidden(); }
  /// Adds the rays of another sampling of the same patch. The hidden origins stay those of the first.
  void append(const TransportRow& more);
};

/// Traces one row for each patch: 256 cosine-distributed rays from 16 stratified origins. An origin most of whose rays meet backs
/// is hidden (under a box, inside a solid) and is left out, so that a patch half under a box has the irradiance of its visible
/// half. In a closed scene a ray that slips through a seam is sent once more beside it, so that rows sum to 1. Rows come in the
/// order of `patches` and do not depend on the number of threads. Requires: as many shapes as patches.
std::vector<TransportRow> trace_rows(const LocalScene& scene, const DirectionSets& directions, std::span<const PatchShape> shapes,
                                     std::span<const PatchId> patches, std::uint64_t seed, RayBudget& budget);

}  // namespace alvor
