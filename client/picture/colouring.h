#pragma once
// Computes the colours of a false-colour picture.

#include "client/picture/false_colour.h"
#include "client/picture/stage.h"

#include <atomic>

namespace alvor {

/// Colours points of a false-colour picture, and records whether values lay outside its scale. Safe from any thread. `stage` must
/// outlive it.
class Colouring {
 public:
  Colouring(const Stage& stage, const Camera& camera, const FalseColour& options);

  /// Returns the linear sRGB colour of a point.
  Rgb colour(const Seen& seen) const;

  const ColourScale& scale() const { return scale_; }
  bool values_below() const { return below_; }
  bool values_above() const { return above_; }

 private:
  const Stage& stage_;
  const FalseColour options_;
  ColourScale scale_;
  mutable std::atomic<bool> below_ = false, above_ = false;
};

}  // namespace alvor
