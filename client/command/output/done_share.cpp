#include "client/command/output/done_share.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

// Errors shrink by factors, so the scale is logarithmic: half is reached at the root of the tolerance.
double share_done(const Step& step, const ProgressGoal& goal) {
  if (step.is_provisional) return 0;
  if (goal.area_share > 0) return std::clamp(step.area_within / goal.area_share, 0.0, 1.0);
  if (step.estimated_error <= goal.tolerance || goal.tolerance >= 1) return 1;
  return std::clamp(std::log(std::min(step.estimated_error, 1.0)) / std::log(goal.tolerance), 0.0, 1.0);
}

}  // namespace

double DoneShare::after(const Step& step) {
  if (step.edits != edits_) done_ = 0;
  edits_ = step.edits;
  return done_ = std::max(done_, share_done(step, goal_));
}

}  // namespace alvor
