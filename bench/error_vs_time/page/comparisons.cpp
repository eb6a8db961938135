#include "bench/error_vs_time/page/comparisons.h"

#include <algorithm>

namespace alvor::bench {

namespace {

std::vector<CurvePoint> our_curve(std::span<const RunGroup> groups) { return error_by_cpu(of(groups, Contender::alvor)); }

/// Returns estimated over true error of the runs that a condition holds for.
template <class Condition>
std::vector<double> ratios_of(std::span<const MeasuredRun> runs, Condition&& is_wanted) {
  std::vector<double> ratios;
  for (const MeasuredRun& run : runs)
    if (is_wanted(run)) ratios.push_back(run.estimated / run.nrmse.value);
  return ratios;
}

}  // namespace

std::optional<Comparison> with_fixed_mesh(std::span<const RunGroup> groups) {
  const auto theirs = error_by_cpu(of(groups, Contender::fixed_mesh));
  if (theirs.empty()) return std::nullopt;
  const CurvePoint best = *std::ranges::min_element(theirs, {}, &CurvePoint::error);
  return Comparison{best.error, cost_to_reach(our_curve(groups), best.error), best.cost};
}

std::optional<Comparison> with_path_tracing(std::span<const RunGroup> groups, std::size_t drawn, double error) {
  auto theirs = error_by_cpu(of(groups, Contender::path_tracing));
  if (theirs.empty()) return std::nullopt;
  for (CurvePoint& point : theirs) point.cost *= points_of_a_scene / static_cast<double>(drawn);
  Comparison comparison{error, cost_to_reach(our_curve(groups), error)};
  const auto reached = cost_to_reach(theirs, error);
  comparison.is_extrapolated = !reached;
  comparison.theirs_s = reached ? reached->cost : sampling_cost_to_reach(theirs.back(), error);
  return comparison;
}

ThreadGain gain_of_two_threads(std::span<const RunGroup> groups) {
  ThreadGain gain;
  const auto two = of(groups, Contender::alvor, 2);
  for (const RunGroup& one : of(groups, Contender::alvor, 1)) {
    const auto same = std::ranges::find(two, one.setting, &RunGroup::setting);
    if (same == two.end() || !one.is_done() || !same->is_done()) continue;
    gain.one_s += one.wall_s().median, gain.two_s += same->wall_s().median;
  }
  return gain;
}

std::vector<double> estimate_ratios(std::span<const MeasuredRun> runs) {
  return ratios_of(runs,
                   [](const MeasuredRun& run) { return run.contender == Contender::alvor && run.threads == 1 && run.is_done; });
}

std::vector<double> estimate_ratios_of_stopped(std::span<const MeasuredRun> runs) {
  return ratios_of(runs, [](const MeasuredRun& run) { return run.contender == Contender::until_time && !run.is_done; });
}

}  // namespace alvor::bench
