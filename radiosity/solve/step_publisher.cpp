#include "radiosity/solve/step_publisher.h"

#include <algorithm>
#include <cstdint>

namespace alvor {

namespace {

// Share of the estimated error by which a display may differ from the solution. Squares add, so a display errs by at most
// sqrt(1 + 0.5^2) = 1.12 times the estimated error. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr double displayed_error = 0.5;
// Largest share of the time that may go into steps that only show progress. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr double publishing_share = 0.1;
// Number of first steps that are published whatever they cost. Chosen; half and double give the same solutions
// (docs/design/constants.md).
constexpr std::uint64_t always_published = 12;

}  // namespace

void StepPublisher::publish_if_due(const Pass& pass) {
  if (!control_.ranks->is_first()) return;
  const bool is_early = log_.head() < always_published;
  if (is_early || clock_.elapsed_s() - published_at_ > live_.publishing_s / publishing_share) publish(pass);
}

void StepPublisher::publish(const Pass& pass, Values values) {
  if (!control_.ranks->is_first() || live_.is_refreshing) return;
  const Step step = step_of(pass);
  log_.publish(values == Values::of_state ? pass.leaf_values() : std::vector<LeafValue>(), step, leaf_errors(pass));
  live_.published_revision = log_.head();
  live_.published_leaves = step.leaves;
  requests_.heed_edits(true);
  published_at_ = clock_.elapsed_s();
  if (values == Values::of_state) live_.publishing_s = published_at_ - step.elapsed_s;
  const double pause_s = live_.state.options.step_pause_s;
  if (pause_s > 0) clock_.pause(pause_s, [this] { return requests_.made_here().any(); });
}

/// Returns whether the log has the leaves of this state, with the values that were published last.
bool StepPublisher::has_published_leaves() const {
  return live_.published_revision == log_.head() && live_.published_leaves == live_.state.leaf_count();
}

Step StepPublisher::step_of(const Pass& pass) const {
  const SolveState& state = live_.state;
  const double error = live_.progress.error.total();
  Step step;
  step.elapsed_s = clock_.elapsed_s();
  step.shots = live_.progress.shots;
  step.rays = live_.budget.rays();
  step.leaves = state.leaf_count();
  if (live_.is_scaled) step.unshot_fraction = log_.last_step().unshot_fraction;
  else if (!live_.error_before_edit || pass.is_exchanging()) step.unshot_fraction = pass.unshot_fraction();
  step.estimated_error = error;
  step.unlit_fraction = state.direct.unlit_fraction();
  step.area_within = live_.error_before_edit ? 0 : live_.by_place.area_within;  // not known yet
  step.edits = control_.edits;
  step.is_provisional = live_.error_before_edit.has_value();
  step.displayed_error = displayed_error * std::min(1.0, live_.error_before_edit.value_or(error));
  if (state.plan.needs(Feature::ambient_display)) step.ambient_irradiance = pass.ambient_irradiance();
  return step;
}

/// Returns the told errors of leaves; none where they are not known.
std::vector<float> StepPublisher::leaf_errors(const Pass& pass) {
  if (live_.is_scaled) return live_.told_errors;
  std::vector<float> errors = pass.leaf_errors(live_.progress.error);
  if (!errors.empty() && control_.live) live_.told_errors = errors;
  return errors;
}

}  // namespace alvor
