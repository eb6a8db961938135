#pragma once
// How a solve is doing, on stderr while it runs.

#include "solution/leaf_value.h"

#include <chrono>
#include <optional>
#include <string>

namespace alvor {

/// On a terminal one line, redrawn at most ten times a second; in a pipe plain lines, at most one a second.
class ProgressLine {
 public:
  /// `tolerance` is the estimated error at which the bar is full.
  explicit ProgressLine(double tolerance);
  ~ProgressLine();  ///< leaves the cursor on a fresh line
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const Step& step);

 private:
  using Clock = std::chrono::steady_clock;
  bool due() const;

  double tolerance_;
  bool terminal_;
  std::optional<Clock::time_point> shown_;
};

/// "[####----] unshot 12.0 %, 4153 leaves, 1.65 M rays, 6.35 M rays/s, 0.26 s"
std::string progress_text(const Step& step, double tolerance);

}  // namespace alvor
