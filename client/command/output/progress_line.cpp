#include "client/command/output/progress_line.h"

#include "client/command/output/numbers.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

// Returns the fraction done, on a logarithmic scale: errors shrink by factors, so half is reached at the root of the tolerance.
double done_share(double estimated_error, double tolerance) {
  if (estimated_error <= tolerance || tolerance >= 1) return 1;
  return std::clamp(std::log(std::min(estimated_error, 1.0)) / std::log(tolerance), 0.0, 1.0);
}

}  // namespace

std::string progress_text(const Step& step, double tolerance) {
  const double rate = step.elapsed_s > 0 ? static_cast<double>(step.rays) / step.elapsed_s : 0;
  return progress_bar(done_share(step.estimated_error, tolerance)) + " unshot " + percent(step.unshot_fraction) + ", " +
         compact(static_cast<double>(step.leaves)) + " leaves, " + compact(static_cast<double>(step.rays)) + " rays, " +
         compact(rate) + " rays/s, " + seconds(step.elapsed_s);
}

void ProgressLine::show(const Step& step) {
  if (line_.due()) line_.show(progress_text(step, tolerance_));
}

}  // namespace alvor
