#pragma once
// The solve: rows, shots and splits until the stopping rule says enough.

#include "meshing/base_mesh.h"
#include "radiosity/plan/plan.h"
#include "radiosity/solve/power_balance.h"
#include "radiosity/solve/solve_control.h"
#include "solution/solution_log.h"

#include <stop_token>
#include <string_view>

namespace alvor {

/// `stalled`: light went round so slowly, or rounding so far, that what is left unshot exceeds the tolerance; the estimated error
/// says by how much. `parked`: SolveControl::park was obeyed.
enum class StopReason { tolerance, max_leaves, max_depth, time_limit, memory, cancelled, dark, stalled, parked };
/// "tolerance", "leaf limit", ... for people.
std::string_view text(StopReason reason);

struct SolveOutcome {
  StopReason reason = StopReason::tolerance;
  double solve_s = 0;          ///< wall seconds
  double cpu_s = 0;            ///< of the threads that worked on it
  double traversal_share = 0;  ///< of that time, spent in ray traversal
  PowerBalance balance;        ///< of the last pass that light went round; all 0 if it was stopped before
};

/// Solves on the calling thread and its worker threads; publishes every step to `log`. Step 1 is published before any ray is
/// traced. Throws BadBytes for a checkpoint that cannot be of this mesh and these options.
/// Requires: !mesh.roots().empty(), log.head() == 0 without a checkpoint; the plan is of this mesh and these options.
SolveOutcome solve_as_planned(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, SolutionLog& log,
                              const SolveControl& control);
/// The same with its own plan; closes the log.
SolveOutcome solve(const BaseMesh& mesh, const SolveOptions& options, SolutionLog& log, std::stop_token stop);

}  // namespace alvor
