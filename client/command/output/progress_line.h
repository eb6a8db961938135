#pragma once
// Shows the progress of a running solve on stderr.

#include "client/command/output/done_share.h"
#include "client/command/output/status_line.h"

#include <string>

namespace alvor {

class ProgressLine {
 public:
  explicit ProgressLine(const ProgressGoal& goal) : done_(goal) {}

  void show(const Step& step);

 private:
  DoneShare done_;
  StatusLine line_;
};

/// Returns a line such as "[####----] unshot 12.0 %, 4153 leaves, 1.65 M rays, 6.35 M rays/s, 0.26 s".
std::string progress_text(const Step& step, double done_share);

}  // namespace alvor
