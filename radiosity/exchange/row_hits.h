#pragma once
// The coupling of patches by the hits of their rows.

#include "radiosity/exchange/shooting.h"

#include <cmath>
#include <cstdint>
#include <span>

namespace alvor {

/// Which patches the rows of a system hit, as far as this rank has the hits. Borrows all.
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

/// A number in [0, 1] or little more as a whole number of 2^-50, with the rounding of a double. Sums of such numbers, modulo
/// 2^64, are the same in any order, on any number of ranks.
inline std::uint64_t fixed_point(double x) { return static_cast<std::uint64_t>(std::llrint(x * 0x1p50)); }
inline double from_fixed_point(std::uint64_t sum) { return static_cast<double>(static_cast<std::int64_t>(sum)) * 0x1p-50; }

}  // namespace alvor
