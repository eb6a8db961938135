#pragma once
// Solves a scene: passes of tracing, exchange and refinement until the stopping rule is met.

#include "meshing/base_mesh.h"
#include "radiosity/plan/plan.h"
#include "radiosity/solve/power_balance.h"
#include "radiosity/solve/solve_control.h"
#include "solution/solution_log.h"

#include <stop_token>
#include <string_view>

namespace alvor {

/// Why a solve ended. `stalled`: the exchange of light converged too slowly, or rounding began too early, to meet the tolerance;
/// the estimated error includes what is left. `parked`: SolveControl::park was obeyed. `edited`: so was SolveControl::is_edited.
enum class StopReason { tolerance, max_leaves, max_depth, time_limit, memory, cancelled, dark, stalled, parked, edited };
/// Returns the reason in words for people: "tolerance reached", "leaf limit reached", ...
std::string_view text(StopReason reason);

struct SolveOutcome {
  StopReason reason = StopReason::tolerance;
  double solve_s = 0;          ///< wall seconds
  double cpu_s = 0;            ///< CPU seconds of the threads that worked on it, on all ranks
  double traversal_share = 0;  ///< share of cpu_s that was spent in ray traversal, in [0, 1]
  PowerBalance balance;        ///< balance of the last pass of which the error was estimated; all 0 if there was none
};

/// Solves on the calling thread and its worker threads; publishes every step to `log`. The first step is published before any ray
/// is traced. With several ranks all of them call this with the same mesh, plan, options and checkpoint; the first publishes, and
/// the bytes that it publishes do not depend on the number of ranks. Throws BadBytes if the checkpoint cannot be of this mesh and
/// these options, and invalid_argument with several ranks where why_on_one_rank() says that the options take one.
/// Requires: !mesh.roots().empty(), log.head() == 0 without a checkpoint; the plan is of this mesh and these options.
SolveOutcome solve_as_planned(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                              const SolveControl& control);
/// Returns why a solve with these options takes a single rank; empty if it does not.
std::string_view why_on_one_rank(const SolveOptions& options);
/// Makes a plan, solves as solve_as_planned() does, and closes the log.
SolveOutcome solve(const BaseMesh& mesh, const SolveOptions& options, SolutionLog& log, std::stop_token stop);

}  // namespace alvor
