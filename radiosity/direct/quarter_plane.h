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
  QuarterPlane(const std::array<double, 4>& quarter, bool is_quad) : is_quad_(is_quad) {
    const auto& [a, b, c, d] = quarter;
    mean_ = (a + b + c + d) / 4;
    along_u_ = is_quad ? b + d - a - c : 2 * (b - a);
    along_v_ = is_quad ? c + d - a - b : 2 * (c - a);
  }
  /// Returns the plane's value at the middle of stratum `o`, at least 0.
  double at_origin(int o) const {
    static const auto quad = middles(4), triangle = middles(3);
    const Uv& at = (is_quad_ ? quad : triangle)[static_cast<std::size_t>(o)];
    return std::max(0.0, mean_ + at.u * along_u_ + at.v * along_v_);
  }

 private:
  /// Returns the offsets of the strata's middles from the middle of the patch.
  static std::array<Uv, origins_per_patch> middles(int corner_count) {
    const PatchShape whole{0, corner_count, {0, 0}, grid_size};
    std::array<Uv, origins_per_patch> at;
    for (int o = 0; o < origins_per_patch; ++o) {
      const Uv middle = whole.child(o >> 2).child(o & 3).centre();
      at[static_cast<std::size_t>(o)] = {middle.u - whole.centre().u, middle.v - whole.centre().v};
    }
    return at;
  }

  bool is_quad_;
  double mean_, along_u_, along_v_;
};

}  // namespace alvor
