#pragma once
// The slow part of an exchange of light, found at once on few unknowns.

#include "radiosity/exchange/coarse_units.h"
#include "radiosity/exchange/dense_lu.h"

#include <array>

namespace alvor {

/// The system y = F (e + rho y) for irradiance that is the same all over each unit, balanced over its area (two-grid correction,
/// Galerkin). Light that changes slowly as it goes round, in a white room or from room to room through small doors, is nearly so.
class CoarseGrid {
 public:
  CoarseGrid(CoarseUnits units, const RowHits& hits);

  /// Replaces in `step`, which begins as the residual, its mean over each unit by the irradiance that would take it away. By
  /// patch.
  void correct(std::span<const Rgb> residual, std::span<Rgb> step) const;

 private:
  using Matrix = std::vector<std::vector<double>>;
  static std::array<Matrix, 3> matrices(const CoarseUnits& units, const RowHits& hits, std::span<const double> weight);

  CoarseUnits units_;
  std::vector<double> weight_;  // by patch: its share of the area of its unit
  std::vector<DenseLu<double>> band_;
};

}  // namespace alvor
