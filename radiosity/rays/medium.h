#pragma once
// A homogeneous medium that absorbs and does not scatter.

#include "solution/rgb.h"

#include <cmath>

namespace alvor {

/// A medium that fills the whole scene.
struct Medium {
  Rgb absorption;  ///< 1/m per band, >= 0

  bool is_clear() const { return absorption.is_zero(); }
  /// Returns the share of light that is left after `distance` metres, per band: exp(-absorption distance) (Bouguer 1729, Lambert
  /// 1760).
  Rgb transmittance(double distance) const {
    return {std::exp(-absorption.r * distance), std::exp(-absorption.g * distance), std::exp(-absorption.b * distance)};
  }
};

}  // namespace alvor
