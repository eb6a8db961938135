#include "client/command/output/progress_line.h"

#include "client/command/output/numbers.h"

namespace alvor {

std::string progress_text(const Step& step, double done_share) {
  const double rate = step.elapsed_s > 0 ? static_cast<double>(step.rays) / step.elapsed_s : 0;
  return progress_bar(done_share) + " unshot " + percent(step.unshot_fraction) + ", " +
         compact(static_cast<double>(step.leaves)) + " leaves, " + compact(static_cast<double>(step.rays)) + " rays, " +
         compact(rate) + " rays/s, " + seconds(step.elapsed_s);
}

void ProgressLine::show(const Step& step) {
  const double done = done_.after(step);
  if (line_.due()) line_.show(progress_text(step, done));
}

}  // namespace alvor
