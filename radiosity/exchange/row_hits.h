#pragma once
// The coupling of patches by the hits of their rows.

#include "radiosity/exchange/shooting.h"

#include <cstdint>
#include <span>

namespace alvor {

/// Which patches the rows of a system hit. Borrows all.
struct RowHits {
  std::span<const ShootingPatch> patches;
  std::span<const std::uint32_t* const> hit_leaf;  ///< by patch, then by hit of its row
  std::span<const std::uint32_t> patch_of_leaf;

  /// Calls body(patch hit, weight) for each hit of the patch's row. The patch's irradiance is the sum over hits of the weight
  /// (per band) times the radiosity of the patch hit.
  template <class Body>
  void for_each(std::size_t patch, Body&& body) const {
    const TransportRow& row = *patches[patch].row;
    if (row.is_hidden()) return;
    const double share = 1.0 / row.ray_count();
    for (std::size_t h = 0; h < row.hits.size(); ++h)
      body(patch_of_leaf[hit_leaf[patch][h]], share * (row.hit_weight.empty() ? Rgb{1, 1, 1} : widen(row.hit_weight[h])));
  }
};

}  // namespace alvor
