#include "client/command/progress_line.h"

#include "client/command/numbers.h"

#include <algorithm>
#include <cmath>
#include <iostream>

#include <unistd.h>

namespace alvor {

namespace {

// Errors shrink by factors, so the bar is logarithmic: half full when half the digits are won.
double done_share(double estimated_error, double tolerance) {
  if (estimated_error <= tolerance || tolerance >= 1) return 1;
  return std::clamp(std::log(std::min(estimated_error, 1.0)) / std::log(tolerance), 0.0, 1.0);
}

std::string bar(double share) {
  constexpr int width = 24;
  const auto full = static_cast<std::size_t>(std::lround(share * width));
  return std::string("[").append(full, '#').append(width - full, '-') + "]";
}

}  // namespace

std::string progress_text(const Step& step, double tolerance) {
  const double rate = step.elapsed_s > 0 ? static_cast<double>(step.rays) / step.elapsed_s : 0;
  return bar(done_share(step.estimated_error, tolerance)) + " unshot " + percent(step.unshot_fraction) + ", " +
         compact(static_cast<double>(step.leaves)) + " leaves, " + compact(static_cast<double>(step.rays)) + " rays, " +
         compact(rate) + " rays/s, " + seconds(step.elapsed_s);
}

ProgressLine::ProgressLine(double tolerance) : tolerance_(tolerance), terminal_(isatty(STDERR_FILENO) == 1) {}

ProgressLine::~ProgressLine() {
  if (terminal_ && shown_) std::cerr << '\n';
}

bool ProgressLine::due() const {
  const std::chrono::milliseconds pause(terminal_ ? 100 : 1000);
  return !shown_ || Clock::now() - *shown_ >= pause;
}

void ProgressLine::show(const Step& step) {
  if (!due()) return;
  shown_ = Clock::now();
  constexpr const char* erase_rest = "\x1b[K";
  const std::string line = progress_text(step, tolerance_);
  std::cerr << (terminal_ ? "\r" + line + erase_rest : line + "\n") << std::flush;
}

}  // namespace alvor
