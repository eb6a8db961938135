#pragma once
// Few groups of patches in which light is nearly even.

#include "radiosity/exchange/row_hits.h"
#include "solution/patch_id.h"

#include <span>
#include <vector>

namespace alvor {

/// A unit for each patch; units count from 0.
struct CoarseUnits {
  std::vector<std::uint32_t> of_patch;
  std::size_t count = 0;

  std::vector<std::vector<std::uint32_t>> members() const;
};

/// The ancestors of patches in their quadtrees, as deep as no more than `most` are reached; the roots, if they are more.
CoarseUnits ancestors(std::span<const PatchId> patches, std::size_t most);

/// Joins units to pairs, each with the one that it sees most of and that is still alone, and again, until they are at most `most`
/// (pairwise aggregation, Notay 2010) or none see each other. Where that goes slowly the others join pairs, as in smoothed
/// aggregation (Vanek et al. 1996). Returns the rounds that took; each looks at all hits.
int join_pairs(CoarseUnits& units, const RowHits& hits, std::size_t most);

}  // namespace alvor
