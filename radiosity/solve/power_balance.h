#pragma once

namespace alvor {

/// The emitted power and what became of it, W, summed over bands. Each receiver has its own samples (its row), so the power that
/// arrives is not exactly the power that was sent. The difference measures the rows' quality independently of the error estimate.
struct PowerBalance {
  double emitted = 0;
  double absorbed = 0;  ///< absorbed by fronts
  double lost = 0;      ///< left the scene, met black backs, or faded in the medium. Without rows to tell: all of the rest
  double unshot = 0;    ///< not distributed yet
  /// Returns the power that is not accounted for, as a share of the emitted power. Negative: more arrived than was sent. 0 in the
  /// dark.
  double gap() const { return emitted > 0 ? (emitted - absorbed - lost - unshot) / emitted : 0; }
};

}  // namespace alvor
