#pragma once
// Transport rows: the stored sampling of a receiver's hemisphere.

#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/ray_budget.h"
#include "radiosity/rays/sampling.h"
#include "solution/rgb.h"

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Where the rays of one patch ended. Hits are places, so they survive later splits. Rays that left the scene or met a black back
/// are counted but not stored: each hit weighs 1 / ray_count(), times hit_weight.
struct TransportRow {
  std::vector<PatchId> hits;  ///< origin after origin, round after round
  /// Of each hit, where hits do not all weigh the same: a hemicube cell's share, what a medium lets through. Empty: all 1.
  std::vector<RgbF> hit_weight;
  /// Hits that each origin has; origins_per_patch entries a round of rays, `not_sampled` for origins that are hidden. Empty where
  /// the row did not come from rays.
  std::vector<std::uint8_t> origin_hits;
  std::uint32_t rays = 0;
  std::uint16_t hidden_origins = 0;  ///< bit o: origin o is hidden, see trace_rows
  bool is_closed = false;            ///< every ray met a front: none left the scene or was absorbed by a back

  static constexpr std::uint8_t not_sampled = 255;
  std::uint32_t ray_count() const { return rays; }
  bool is_hidden() const { return rays == 0; }
  /// The outline of a solid that stands on the patch runs through it.
  bool crosses_contact() const { return hidden_origins != 0 && !is_hidden(); }
  /// The part of the patch that no solid stands on.
  double visible_share() const { return 1 - std::popcount(hidden_origins) / double(origins_per_patch); }
  /// Sum of what the hits weigh, times ray_count().
  Rgb stored_weight() const;
  /// Adds another round of rays of the same patch. The hidden origins stay those of the first.
  void append(const TransportRow& more);
};

/// How many rays a row begins with: 16 from each of 16 origins, or from one origin a quarter, for patches that matter little.
/// `hidden_only` stores no hits: it looks with one ray an origin, and where any meets a back as a whole row does, for what is
/// hidden.
enum class RowSize : std::uint8_t { whole, small, hidden_only };

/// What rows have to find out. What they have not takes no time.
struct RowNeeds {
  bool back_sides = true;  ///< false: no face has a twin
  bool places = true;      ///< where on a face a hit is; false: patches are never split, and each hit is the id of its root
};

/// Traces one row for each patch: 256 (or 64) cosine-distributed rays from 16 (or 4) stratified origins. An origin most of whose
/// rays meet backs is hidden (under a box, inside a solid) and is left out, so that a patch half under a box has the irradiance
/// of its visible half. In a closed scene a ray that slips through a seam is sent once more beside it, so that rows sum to 1.
/// Rows come in the order of `patches` and do not depend on the number of threads. Requires: as many shapes and sizes as patches.
std::vector<TransportRow> trace_rows(const LocalScene& scene, const DirectionSets& directions, std::span<const PatchShape> shapes,
                                     std::span<const PatchId> patches, std::span<const RowSize> sizes, std::uint64_t seed,
                                     RayBudget& budget, RowNeeds needs = {});

}  // namespace alvor
