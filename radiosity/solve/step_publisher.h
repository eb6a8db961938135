#pragma once
// Publishes the steps of a solve in its log.

#include "radiosity/solve/live_solve.h"
#include "radiosity/solve/solve_clock.h"
#include "radiosity/solve/stop_requests.h"
#include "solution/solution_log.h"

#include <vector>

namespace alvor {

/// Publishes the state of a solve and its progress, step by step. Does nothing on ranks other than the first. Borrows all that it
/// is made with. Used by one thread at a time.
class StepPublisher {
 public:
  StepPublisher(LiveSolve& live, SolutionLog& log, const SolveControl& control, SolveClock& clock, StopRequests& requests)
      : live_(live), log_(log), control_(control), clock_(clock), requests_(requests) {}

  /// Publishes the light of a pass, and its told errors where they are known. Edits are heeded from then on, and the solve pauses
  /// where that was asked for. Does nothing while the solve is being refreshed.
  void publish(const Pass& pass) { publish(pass, Values::of_state); }
  /// Publishes a step that only shows progress, if it is one of the first twelve or publishing takes less than a tenth of the
  /// time.
  void publish_if_due(const Pass& pass);
  /// Publishes that objects have moved, in the light of before: without values of leaves if the log has those of this state.
  void publish_moved(const Pass& pass) { publish(pass, has_published_leaves() ? Values::as_published : Values::of_state); }

 private:
  /// Which values of leaves a step has: those of the state, or none, where the log keeps those that it has.
  enum class Values { of_state, as_published };
  void publish(const Pass& pass, Values values);
  bool has_published_leaves() const;
  Step step_of(const Pass& pass) const;
  std::vector<float> leaf_errors(const Pass& pass);

  LiveSolve& live_;
  SolutionLog& log_;
  const SolveControl& control_;
  SolveClock& clock_;
  StopRequests& requests_;
  double published_at_ = 0;  // elapsed seconds
};

}  // namespace alvor
