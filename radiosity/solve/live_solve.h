#pragma once
// The state and progress of a solve, which can stay in memory when the solve has ended, so that it goes on after an edit.

#include "radiosity/solve/pass.h"
#include "radiosity/solve/solve_control.h"
#include "radiosity/solve/solve_state.h"
#include "radiosity/solve/solver.h"
#include "solution/solution_log.h"

#include <functional>
#include <memory>
#include <optional>

namespace alvor {

/// The progress of a run that is not part of its state. Saved with checkpoints as it lies in memory.
struct Progress {
  double elapsed_s = 0, cpu_s = 0, traversal_s = 0;
  std::uint64_t rays = 0, shots = 0;
  std::uint64_t passes = 0;  ///< passes that came to their end
  ErrorEstimate error{.unshot = 1};
  PowerBalance balance;
  double lowest_error = 0;
  std::uint64_t leaves_before = 0;  ///< leaves in the last pass that gained something
  std::uint64_t idle_passes = 0;    ///< passes since then
};

/// The state and the progress of one solve. Used by one thread at a time.
class LiveSolve {
 public:
  /// Begins a solve. If `keeps_mesh`, it has a copy of the mesh and can take edits; else the mesh must outlive it. The ranks
  /// must.
  LiveSolve(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, Ranks& ranks, bool keeps_mesh);
  LiveSolve(const LiveSolve&) = delete;  // its parts refer to each other

  /// Goes on with the materials, lights and medium of `edited`, whose plan this is. Returns false, and changes nothing, where a
  /// solve from the beginning is needed, or cheaper because edits have left many leaves that show no detail any more. Requires:
  /// keeps_mesh.
  bool take_edit(const BaseMesh& edited, const Plan& plan);

  /// Collective.
  void save(PlainWriter& out) const;
  /// Reads what save() wrote. Throws BadBytes; then this must not be used. Requires: newly made.
  void load(std::span<const std::byte> checkpoint);

 private:
  bool has_too_many_leaves() const;
  bool may_scale() const;
  void scale(double factor);

  std::optional<BaseMesh> own_mesh_;

 public:
  std::function<bool()> is_out = [] { return false; };  ///< asked by the budget, from any thread
  RayBudget budget{[this] { return is_out(); }};
  SolveState state;
  Progress progress;
  ErrorByPlace by_place{.area_within = 0, .kept_error = 1};
  std::uint64_t edits = 0;  ///< SolveControl::edits of the mesh
  double edited_at_s = 0;   ///< elapsed seconds when the last edit was taken
  /// When the solve first ended by its tolerance or a limit of the mesh: its leaves, 0 until then, and the estimated error.
  std::uint64_t leaves_at_first_end = 0;
  std::uint64_t added_leaves = 0;  ///< the first leaves of objects that edits have added since then; not saved
  double error_at_first_end = 0;
  /// Until the first estimate after an edit: the estimated error of before.
  std::optional<double> error_before_edit;
  bool follows_closely = false;  ///< the last edit came before the first estimate after the one before; not saved
  /// The errors told last, W/m2, in the order of the leaves; of other leaves where there are more or fewer. Kept for edits only.
  std::vector<float> told_errors;
  std::optional<StopReason> ended_with;  ///< the tolerance or a limit of the mesh; nothing if the solve has not ended by one
  /// The last edit multiplied all light by one factor, and nothing was published since. Only if ended_with has a value.
  bool is_scaled = false;
  double publishing_s = 0;  ///< wall seconds that publishing the values of all leaves took last; not saved
  std::uint64_t published_revision = 0,
                published_leaves = 0;  ///< of the last step that was published, and how many leaves; not saved
  bool is_refreshing = false;  ///< the log shows an older solution, and nothing is published before the first pass is done
};

/// Returns the state from which a solve of `mesh` goes on, or a new one. Throws BadBytes.
std::shared_ptr<LiveSolve> live_solve(const BaseMesh& mesh, const Plan& plan, const SolveOptions& options, const SolutionLog& log,
                                      const SolveControl& control);

}  // namespace alvor
