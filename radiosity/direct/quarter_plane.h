#pragma once
// Interpolates values of a patch's four quarters to its sixteen strata.

#include "meshing/patch_place.h"
#include "radiosity/rays/sampling.h"

#include <algorithm>
#include <array>

namespace alvor {

/// A plane fitted to four values at the quarters of a patch: their mean at the centre, their differences along the patch's axes.
class QuarterPlane {
 public:
  QuarterPlane(const std::array<double, 4>& quarter, const PatchShape& patch) : strata_(Strata::of(patch)), centre_(patch.corner_count == 3 ? 1 / 3.0f : 0.5f) {
    const auto& [a, b, c, d] = quarter;
    mean_ = (a + b + c + d) / 4;
    if (patch.corner_count == 3) along_ = {2 * (b - a), 2 * (c - a)};
    else if (patch.strata_along_u == 4) along_ = {b + d - a - c, c + d - a - b};
    // Least squares over quarters in a row, at -3/8, -1/8, 1/8 and 3/8 of the length.
    else if (const double along = (3 * (d - a) + c - b) / 2.5; patch.strata_along_u > 4) along_ = {along, 0};
    else along_ = {0, along};
  }
  /// Returns the plane's value at the middle of stratum `o`, at least 0.
  double at_origin(int o) const {
    const auto n = static_cast<std::size_t>(o);
    return std::max(0.0, mean_ + (strata_.u[n] - centre_) * along_.u + (strata_.v[n] - centre_) * along_.v);
  }

 private:
  const Strata& strata_;
  float centre_;
  double mean_;
  Uv along_;
};

}  // namespace alvor
