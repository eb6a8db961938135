#pragma once
// Shows the progress of a running solve on stderr.

#include "client/command/output/status_line.h"
#include "solution/leaf_value.h"

#include <string>

namespace alvor {

class ProgressLine {
 public:
  /// `tolerance` is the estimated error at which the bar is full.
  explicit ProgressLine(double tolerance) : tolerance_(tolerance) {}

  void show(const Step& step);

 private:
  double tolerance_;
  StatusLine line_;
};

/// Returns a line such as "[####----] unshot 12.0 %, 4153 leaves, 1.65 M rays, 6.35 M rays/s, 0.26 s".
std::string progress_text(const Step& step, double tolerance);

}  // namespace alvor
