#pragma once
// A false-colour picture's colours.

#include "client/picture/false_colour.h"
#include "client/picture/stage.h"

#include <atomic>

namespace alvor {

/// Colours the places of one picture, and notes whether its scale was too short for them. Safe from any thread. `stage` must
/// outlive it.
class Colouring {
 public:
  Colouring(const Stage& stage, const Camera& camera, const FalseColour& options);

  /// Linear sRGB.
  Rgb colour(const Seen& seen) const;

  const ColourScale& scale() const { return scale_; }
  bool values_below() const { return below_; }
  bool values_above() const { return above_; }

 private:
  const Stage& stage_;
  Band band_;
  ColourScale scale_;
  mutable std::atomic<bool> below_ = false, above_ = false;
};

}  // namespace alvor
