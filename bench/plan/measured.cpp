#include "bench/plan/measured.h"

#include "bench/error_vs_time/contest/stopwatch.h"
#include "bench/plan/heap.h"
#include "meshing/patch_place.h"

#include <algorithm>
#include <cmath>

namespace alvor::bench {

namespace {

double power(const BaseMesh& mesh, const PlanRun& run) {
  double power = 0;
  for (const LeafValue& leaf : run.lit_leaves) power += area_of(mesh, shape_of(mesh, leaf.patch)) * widen(leaf.irradiance).mean();
  return power;
}

PlanRun run_once(const BaseMesh& mesh, const SolveOptions& options) {
  PlanRun run;
  const std::size_t before = begin_heap_peak();
  const Stopwatch watch;
  SolutionLog log;
  solve(mesh, options, log, {});
  run.cpu_s = watch.cpu_s();
  run.bytes = heap_peak() - before;
  run.rays = log.last_step().rays;
  run.leaves = log.last_step().leaves;
  run.estimated = log.last_step().estimated_error;
  run.lit_leaves = log.leaves();
  std::erase_if(run.lit_leaves, [](const LeafValue& leaf) { return leaf.irradiance.is_zero(); });
  std::ranges::sort(run.lit_leaves, {}, &LeafValue::patch);
  return run;
}

}  // namespace

SolveOptions options_of(const PlanCase& planned, bool forced) {
  SolveOptions options = planned.options;
  if (forced) options.forced_on = planned.features;
  return options;
}

PlanRun measure(const PlanCase& planned, bool forced, int runs) {
  const BaseMesh mesh(planned.scene);
  PlanRun best = run_once(mesh, options_of(planned, forced));
  for (int n = 1; n < runs; ++n) best.cpu_s = std::min(best.cpu_s, run_once(mesh, options_of(planned, forced)).cpu_s);
  return best;
}

Difference difference(const PlanCase& planned, const PlanRun& a, const PlanRun& b) {
  if (!std::ranges::equal(a.lit_leaves, b.lit_leaves, {}, &LeafValue::patch, &LeafValue::patch)) {
    const BaseMesh mesh(planned.scene);
    return {false, std::abs(power(mesh, a) / power(mesh, b) - 1)};
  }
  double largest = 0, difference = 0;
  for (std::size_t n = 0; n < a.lit_leaves.size(); ++n) {
    largest = std::max<double>(largest, b.lit_leaves[n].irradiance.max());
    difference = std::max<double>(difference, absolute(a.lit_leaves[n].irradiance - b.lit_leaves[n].irradiance).max());
  }
  return {true, largest > 0 ? difference / largest : 0};
}

}  // namespace alvor::bench
