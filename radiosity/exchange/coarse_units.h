#pragma once
// Groups patches into a few units over which light is nearly constant.

#include "radiosity/exchange/row_hits.h"
#include "radiosity/ranks/deal.h"
#include "solution/patch_id.h"

#include <span>
#include <vector>

namespace alvor {

/// A partition of patches into units, which are numbered from 0.
struct CoarseUnits {
  std::vector<std::uint32_t> of_patch;  ///< unit of each patch
  std::size_t count = 0;

  std::vector<std::vector<std::uint32_t>> members() const;  ///< patches of each unit
};

/// Returns units that are the patches' ancestors in their quadtrees at the deepest level that has no more than `most` of them;
/// the roots if these are more.
CoarseUnits ancestors(std::span<const PatchId> patches, std::size_t most);

/// Collective. Joins units in rounds until they are at most `most` or none see each other. In a round each unit forms a pair with
/// the unpaired unit that it sees most of (pairwise aggregation, Notay 2010). If that leaves more than 90 % of the units,
/// unpaired ones join the pairs, as in smoothed aggregation (Vanek et al. 1996). What a unit sees are the eight units that each
/// of its patches sees most of. The ranks tell each other these; `patches` says which rank has the hits of each patch. Returns
/// the number of rounds.
int join_pairs(CoarseUnits& units, const RowHits& hits, std::size_t most, Ranks& ranks = Ranks::alone(),
               const Deal& patches = {});

}  // namespace alvor
