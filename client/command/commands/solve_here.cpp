#include "client/command/commands/solve_here.h"

#include "client/command/commands/interrupt.h"
#include "client/command/options/option_checks.h"
#include "client/command/output/display.h"
#include "client/command/output/failure.h"
#include "client/command/output/notes.h"
#include "client/command/output/numbers.h"
#include "client/command/output/status_line.h"
#include "client/rpc/in_process.h"
#include "solution/solution_mirror.h"

#include <array>

namespace alvor {

namespace {

/// Returns the newest state of a log, with the errors that it tells.
DisplayMesh mesh_of(const BaseMesh& mesh, const SolutionLog& log) {
  Cursor start;
  start.errors.are_wanted = true;
  SolutionMirror mirror;
  if (const auto fault = mirror.apply(log.since(start))) throw Failure(ExitStatus::failed, *fault);
  return solution_mesh(mesh, mirror.leaves(), mirror.errors());
}

}  // namespace

void add_solve_limits(CLI::App& command, SolveOptions& options) {
  command.add_option("--tolerance", options.tolerance, "Solve until the estimated relative error is this small (0.02)")
      ->check(above_up_to(0, 1));
  command.add_option("--max-elements", options.max_leaves, "Stop refining at this many leaves (200000)")->check(whole_from(1));
  command.add_option("--time-limit", options.time_limit_s, "Stop solving after this many seconds")->check(above_up_to(0, 1e9));
  command.add_option("--threads", options.threads, "Worker threads of the solve (as many as the machine has)")
      ->check(CLI::Range(1, 1024));
  command.add_option("--seed", options.seed, "The same seed gives the same solution (1)")->check(whole_from(0));
}

std::string why_unfinished(std::string_view end_reason, double estimated_error) {
  if (end_reason == text(StopReason::tolerance)) return {};
  return "the solve ended before its tolerance: " + std::string(end_reason) + ", estimated error " + percent(estimated_error);
}

SolvedHere solve_here(const Scene& scene, const SolveOptions& options, const std::string& name) {
  const BaseMesh mesh(scene);
  if (mesh.roots().empty()) throw Failure(ExitStatus::bad_scene, name + ": all faces are degenerate");
  const Interrupt interrupt;
  SolutionLog log;
  StatusLine line;
  const auto show = [&](const Step& step) {
    line.show("solving: estimated error " + percent(step.estimated_error) + ", " + std::to_string(step.leaves) + " leaves");
  };
  const auto handle = log.listen([&] {
    if (line.due()) show(log.last_step());
  });
  const SolveOutcome outcome = solve_on_ranks(scene, mesh, options, log, interrupt.token());
  log.forget(handle);
  show(log.last_step());
  if (outcome.reason == StopReason::cancelled) throw Failure(ExitStatus::failed, "the solve was cancelled");
  SolvedHere solved{mesh_of(mesh, log), why_unfinished(text(outcome.reason), log.last_step().estimated_error)};
  if (!solved.unfinished.empty()) warn(std::array{solved.unfinished});
  return solved;
}

}  // namespace alvor
