#include "bench/error_vs_time/contest/contenders.h"

#include "bench/error_vs_time/contest/fixed_mesh_shooting.h"
#include "bench/error_vs_time/contest/stopwatch.h"
#include "client/verify/irradiance_estimate.h"
#include "radiosity/solve/solver.h"
#include "solution/solution_mirror.h"

#include <cstdint>
#include <span>
#include <stdexcept>

namespace alvor::bench {

namespace {

Strategy strategy_of(Contender contender) {
  switch (contender) {
    case Contender::gather: return Strategy::gather;
    case Contender::shoot: return Strategy::shoot;
    case Contender::sorted:
    case Contender::sorted_to_depth: return Strategy::sorted;
    case Contender::overshoot: return Strategy::overshoot;
    default: return Strategy::automatic;
  }
}

MethodParts parts_of(Contender contender) {
  constexpr MethodParts none{false, false, false, false};
  MethodParts parts = lacks_parts(contender) ? none : MethodParts{};
  switch (contender) {
    case Contender::exact_shadows_alone: parts.exact_shadows = true; break;
    case Contender::guided_rays_alone: parts.guided_rays = true; break;
    case Contender::slabs_alone: parts.slabs = true; break;
    case Contender::unseen_places_alone: parts.unseen_places = true; break;
    case Contender::no_exact_shadows: parts = {.exact_shadows = false}; break;
    case Contender::no_guided_rays: parts = {.guided_rays = false}; break;
    case Contender::no_slabs: parts = {.slabs = false}; break;
    case Contender::no_unseen_places: parts = {.unseen_places = false}; break;
    default: break;
  }
  return parts;
}

SolveOptions options_of(const Arena& arena, Contender contender, double setting) {
  constexpr double never_reached = 1e-5;
  SolveOptions options{.tolerance = setting,
                       .max_leaves = 1'000'000,
                       .time_limit_s = arena.time_limit_s,
                       .strategy = strategy_of(contender),
                       .parts = parts_of(contender)};
  switch (contender) {
    case Contender::until_time: options.tolerance = never_reached, options.time_limit_s = setting; break;
    case Contender::to_depth:
    case Contender::sorted_to_depth:
      options.tolerance = tolerance_of_limited_meshes, options.max_depth = static_cast<int>(setting);
      break;
    case Contender::to_leaves:
      options.tolerance = tolerance_of_limited_meshes, options.max_leaves = static_cast<std::uint64_t>(setting);
      break;
    default: break;
  }
  return options;
}

/// Writes down what the solution's errors are, and whether those that it tells are true.
void judge(MeasuredRun& run, const Arena& arena, const DisplayMesh& solution) {
  const ErrorStatistics errors = errors_of(solution, arena.truth);
  run.nrmse = errors.nrmse, run.relative_rms = errors.relative_rms;
  if (!solution.errors.empty()) run.within_two = within_two_told(solution, arena.truth);
}

DisplayMesh display_of(const BaseMesh& mesh, const SolutionLog& log) {
  Cursor from_nothing;
  from_nothing.errors.are_wanted = true;
  SolutionMirror mirror;
  if (const auto fault = mirror.apply(log.since(from_nothing))) throw std::logic_error(*fault);
  return build_display_mesh(mesh, mirror.leaves(), mirror.errors());
}

/// Counts the steps of a solve whose estimate is far above that of the step before.
void count_rises(MeasuredRun& run, std::span<const Step> steps) {
  run.steps = steps.size();
  for (std::size_t n = 1; n < steps.size(); ++n)
    run.rises += steps[n].estimated_error > MeasuredRun::far_above * steps[n - 1].estimated_error;
}

}  // namespace

MeasuredRun solve_with(const Arena& arena, Contender contender, double setting, int threads, std::uint64_t seed) {
  SolutionLog log;
  SolveOptions options = options_of(arena, contender, setting);
  options.threads = threads, options.seed = seed;
  const SolveOutcome outcome = solve(arena.mesh, options, log, {});
  const Step last = log.last_step();
  MeasuredRun run{arena.settings.name, contender, setting, threads, seed, outcome.cpu_s, outcome.solve_s};
  run.rays = last.rays, run.leaves = last.leaves, run.estimated = last.estimated_error;
  judge(run, arena, display_of(arena.mesh, log));
  run.is_done = outcome.reason == StopReason::tolerance;
  count_rises(run, log.steps());
  return run;
}

MeasuredRun shoot_with(const Arena& arena, int cells) {
  const FixedMeshSolution solution = shoot_on_fixed_mesh(arena.mesh, {.cells = cells, .time_limit_s = arena.fixed_mesh_limit_s});
  MeasuredRun run{arena.settings.name, Contender::fixed_mesh, double(cells), 1, 1, solution.cpu_s, solution.wall_s};
  run.rays = solution.rays, run.leaves = solution.leaves.size();
  judge(run, arena, build_display_mesh(arena.mesh, solution.leaves));
  run.is_done = solution.is_done;
  return run;
}

MeasuredRun trace_with(const Arena& arena, std::uint64_t paths) {
  constexpr std::uint64_t seed = 1;  // another seed than the truth's
  const Stopwatch watch;
  const PathTracer tracer(arena.scene);
  std::vector<SurfacePoint> points;
  for (const TruePoint& point : arena.truth.points) points.push_back(point.at);
  const auto traced = trace_irradiance(tracer, points, {.paths = paths, .seed = seed, .threads = 1});
  MeasuredRun run{arena.settings.name, Contender::path_tracing, double(paths), 1, seed, watch.cpu_s(), watch.wall_s()};
  std::vector<double> estimates;
  for (const IrradianceEstimate& estimate : traced) estimates.push_back(estimate.mean().mean());
  const ErrorStatistics errors = errors_of(estimates, arena.truth);
  run.nrmse = errors.nrmse, run.relative_rms = errors.relative_rms;
  return run;
}

}  // namespace alvor::bench
