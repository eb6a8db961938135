#pragma once
// The solve: rows, shots and splits until the stopping rule says enough.

#include "meshing/base_mesh.h"
#include "radiosity/plan.h"
#include "radiosity/solve_control.h"
#include "radiosity/strategies.h"
#include "solution/feature.h"
#include "solution/solution_log.h"

#include <cstdint>
#include <limits>
#include <stop_token>
#include <string_view>

namespace alvor {

/// How transport rows are found. From emitters form factors are exact in any case.
enum class FormFactorMethod {
  automatic,  ///< the better one: nusselt
  nusselt,    ///< cosine-distributed rays
  hemicube,   ///< rays through the cells of hemicubes, weighted by delta form factors
  analytic,   ///< no rays: exact form factors between all patches, again in each pass. O(n2): for small scenes
};

/// Everything that decides a solve. The same mesh, options and seed give the same bytes.
struct SolveOptions {
  double tolerance = 0.02;  ///< stop when the estimated nRMSE is at or below this; > 0
  int max_depth = 10;       ///< quadtree levels below the roots; 0 does not refine; <= PatchId::max_level
  std::uint64_t max_leaves = 200'000;
  double min_edge_m = 0;  ///< no split makes an edge shorter than this
  double time_limit_s = std::numeric_limits<double>::infinity();
  int threads = 0;  ///< 0: as many as the machine has
  std::uint64_t seed = 1;
  Strategy strategy = Strategy::automatic;
  FormFactorMethod form_factors = FormFactorMethod::automatic;
  double step_pause_s = 0;  ///< waits this long after each published step, for people who watch; not counted as solving time
  FeatureSet forced_on;     ///< kept on though the plan would switch them off: for tests and measurements
};

/// `stalled`: light went round so slowly, or rounding so far, that what is left unshot exceeds the tolerance; the estimated error
/// says by how much. `parked`: SolveControl::park was obeyed.
enum class StopReason { tolerance, max_leaves, max_depth, time_limit, memory, cancelled, dark, stalled, parked };
/// "tolerance", "leaf limit", ... for people.
std::string_view text(StopReason reason);

/// Where the emitted power went, W, bands together. Rows are samples, each receiver's its own: what arrives is not exactly what
/// was sent, and the difference tells how good they are, whatever the estimate of the error says.
struct PowerBalance {
  double emitted = 0;
  double absorbed = 0;  ///< by fronts
  double lost = 0;      ///< left the scene, met black backs, or faded in the medium; where no rows tell: the rest
  double unshot = 0;    ///< not distributed yet
  /// What is not accounted for, of the emitted power; negative: more came than was sent. 0 in the dark.
  double gap() const { return emitted > 0 ? (emitted - absorbed - lost - unshot) / emitted : 0; }
};

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
