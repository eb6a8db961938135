#pragma once
// How much of a solve is done, for a bar of progress.

#include "solution/leaf_value.h"

#include <cstdint>

namespace alvor {

/// When a solve is done.
struct ProgressGoal {
  double tolerance = 0;   ///< the told error to be reached, > 0
  double area_share = 0;  ///< the share of the area that is to be within the tolerance; 0: `tolerance` is for the whole scene
};

/// How much of a solve is done. Estimates go up and down; what is told here goes back only where the scene was edited.
class DoneShare {
 public:
  explicit DoneShare(const ProgressGoal& goal) : goal_(goal) {}
  /// Takes a later step and returns the share that is done, in [0, 1].
  double after(const Step& step);

 private:
  ProgressGoal goal_;
  std::uint64_t edits_ = 0;
  double done_ = 0;
};

}  // namespace alvor
