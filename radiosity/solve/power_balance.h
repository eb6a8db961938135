#pragma once

namespace alvor {

/// Where the emitted power went, W, bands together. Rows are samples, each receiver's its own: what arrives is not exactly what
/// was sent, and the difference tells how good they are, whatever the estimate of the error says.
struct PowerBalance {
  double emitted = 0;
  double absorbed = 0;  ///< by fronts
  double lost = 0;      ///< left the scene, met black backs, or faded in the medium; where no rows tell: the rest
  double unshot = 0;    ///< not distributed yet
  /// What is not accounted for, as a share of the emitted power; negative: more came than was sent. 0 in the dark.
  double gap() const { return emitted > 0 ? (emitted - absorbed - lost - unshot) / emitted : 0; }
};

}  // namespace alvor
