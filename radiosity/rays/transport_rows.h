#pragma once
// Transport rows: the stored sampling of a receiver's hemisphere.

#include "radiosity/rays/direction_guide.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/ray_budget.h"
#include "radiosity/rays/sampling.h"
#include "solution/rgb.h"

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The places where the rays of one patch ended, and where they crossed panes that reflect, absorb or emit. A hit is a place on a
/// root patch, so it survives later splits. Rays that left the scene or met a black back are counted but not stored. Each hit has
/// the weight 1 / ray_count(), times its hit_weight.
struct TransportRow {
  std::vector<PatchId> hits;  ///< ordered by round of rays, then by origin
  /// Weight of each hit, per band: the transmittance of the medium and of the panes before it, times the weight of a guided ray,
  /// 16 delta form factors of a hemicube's cell, or the form factor of an exact row. Empty: all weights are 1.
  std::vector<RgbF> hit_weight;
  /// Number of hits of each origin, origins_per_patch entries per round of rays; `not_sampled` for an origin that is hidden or
  /// that a small row left out. Empty if the row did not come from rays.
  std::vector<std::uint8_t> origin_hits;
  std::uint32_t rays = 0;
  std::uint16_t hidden_origins = 0;  ///< bit o: origin o is hidden, see trace_rows
  bool is_closed = false;            ///< every counted ray met a front: none left the scene or was absorbed by a back

  static constexpr std::uint8_t not_sampled = 255;
  std::uint32_t ray_count() const { return rays; }
  bool is_hidden() const { return rays == 0; }
  /// Returns whether the outline of a solid that stands on the patch runs through it: some origins are hidden, not all.
  bool crosses_contact() const { return hidden_origins != 0 && !is_hidden(); }
  /// Returns the share of the patch's origins, in [0, 1], on which no solid stands.
  double visible_share() const { return 1 - std::popcount(hidden_origins) / double(origins_per_patch); }
  /// Returns the sum of the hits' weights, times ray_count().
  Rgb stored_weight() const;
  /// Adds another round of rays of the same patch. The hidden origins stay those of the first round. Either row may be without
  /// the hits that origin_hits counts, if both are.
  void append(const TransportRow& more);
};

/// How many rays a row begins with. `whole`: 16 rays from each of 16 origins. `small`, for patches that matter little: 16 rays
/// from one origin in each quarter. `hidden_only` finds hidden origins and stores no hits: it sends one ray from each origin, and
/// the rays of a whole row if any of these meets a back.
enum class RowSize : std::uint8_t { whole, small, hidden_only };

/// Which properties of hits rows have to find. A property that is off takes no time.
struct RowNeeds {
  bool back_sides = true;  ///< false: no face has a twin
  bool panes = true;       ///< false: no face is a pane
  bool places = true;      ///< the place of a hit on its face; false: patches are never split, and each hit is the id of its root
};

/// Traces one row for each patch and returns them in the order of `patches`: 256 (or 64) rays from 16 (or 4) stratified origins,
/// in directions of `directions`, or as a patch's guide says. A guided row's weights are scaled so that each quarter counts for
/// as many cosine-distributed rays as it sent; rows of closed scenes sum to 1. `guides` are by patch, or none at all; a null or
/// an empty one guides nothing. An origin of which more than half of the rays meet backs is hidden (under a box, inside a solid)
/// and is left out, so that a patch half under a box has the irradiance of its visible half. In a closed scene a ray that slips
/// through a seam is sent once more, slightly turned, so that rows sum to 1. Rows do not depend on the number of threads. Returns
/// early where the budget is out. Requires: as many shapes and sizes as patches.
std::vector<TransportRow> trace_rows(const LocalScene& scene, const DirectionSets& directions, std::span<const PatchShape> shapes,
                                     std::span<const PatchId> patches, std::span<const RowSize> sizes, std::uint64_t seed,
                                     RayBudget& budget, RowNeeds needs = {}, std::span<const DirectionGuide* const> guides = {});

}  // namespace alvor
