#pragma once
// Solves for the slowly converging part of an exchange of light directly, with few unknowns.

#include "radiosity/exchange/coarse_units.h"
#include "radiosity/exchange/dense_lu.h"

#include <array>

namespace alvor {

/// The system y = F (e + R y) restricted to irradiance that is constant over each unit, averaged over the unit's area (two-grid
/// correction, Galerkin). Light that converges slowly, in a white room or from room to room through small doors, is nearly
/// constant over units.
class CoarseGrid {
 public:
  /// Collective.
  CoarseGrid(CoarseUnits units, const RowHits& hits, Ranks& ranks = Ranks::alone());

  /// Improves `step`, which holds the residual at first: replaces its mean over each unit by the irradiance that removes the mean
  /// of the residual. Both spans are by patch.
  void correct(std::span<const RelativeLight> residual, std::span<RelativeLight> step) const;

 private:
  /// The matrices of three bands in fixed point, by unit, then unit hit, then band.
  static std::vector<std::uint64_t> matrices(const CoarseUnits& units, const RowHits& hits, std::span<const double> weight);

  CoarseUnits units_;
  std::vector<double> weight_;  // each patch's share of the area of its unit
  std::vector<DenseLu<double>> band_;
};

}  // namespace alvor
