#include "bench/error_vs_time/page/targets.h"

#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/page/comparisons.h"
#include "bench/error_vs_time/page/limits.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace alvor::bench {

namespace {

constexpr double faster_than_path_tracing = 100, faster_than_fixed_mesh = 30;
constexpr double tolerance_kept = 0.02;
constexpr double halved = 1.8;  // speedup with two threads that counts as half the time

constexpr double slope_wanted = -0.8;                                // d log error / d log time
constexpr double estimate_close = 1.5, estimate_limit = 2, most_close = 0.95;
constexpr double least_within_two = 0.9, most_within_two = 0.99;     // of the points, where errors are told

enum class ErrorKind { nrmse, relative_rms };
struct TimeTarget {
  const char* scene;
  ErrorKind kind;
  double error, yardsticks;
};
constexpr TimeTarget time_targets[]{
    {"cornell_box", ErrorKind::nrmse, 0.01, 0.15},        {"cornell_box", ErrorKind::nrmse, 0.005, 0.6},
    {"cornell_box", ErrorKind::relative_rms, 0.02, 0.12}, {"cornell_box", ErrorKind::relative_rms, 0.01, 0.5},
    {"furnished_room", ErrorKind::nrmse, 0.02, 2},        {"furnished_room", ErrorKind::nrmse, 0.01, 8},
    {"louvred_room", ErrorKind::nrmse, 0.05, 6},          {"louvred_room", ErrorKind::nrmse, 0.02, 30},
    {"slats_and_boxes", ErrorKind::nrmse, 0.02, 4},       {"enfilade", ErrorKind::nrmse, 0.02, 6},
    {"vault", ErrorKind::nrmse, 0.02, 2},               {"office_5000", ErrorKind::nrmse, 0.05, 6},
    {"office_50000", ErrorKind::nrmse, 0.1, 20}};
constexpr const char* tolerance_scenes[]{"slats_and_boxes", "vault", "enfilade"};
constexpr const char* slope_scene = "furnished_room";
constexpr double slope_from = 0.05;         // the largest error of the curve's part that is judged
constexpr double most_memory_mb = 500;
constexpr double most_rises = 0.05;         // of the published steps
constexpr double most_leaves_at = 0.02, most_leaves = 80'000;  // at this tolerance, in slope_scene

const SceneContest* find(std::span<const SceneContest> contests, std::string_view name) {
  const auto found =
      std::ranges::find(contests, name, [](const SceneContest& held) -> std::string_view { return held.settings.name; });
  return found == contests.end() ? nullptr : &*found;
}

std::string cost_text(const std::optional<Reached>& reached, double yardstick_s) {
  if (!reached) return "not reached";
  return (reached->at_most ? "at most " : "") + plain(reached->cost) + " s, " + plain(reached->cost / yardstick_s) +
         " yardsticks";
}

Judgement judge_time(const SceneContest* held, const TimeTarget& target, double yardstick_s) {
  const bool is_relative = target.kind == ErrorKind::relative_rms;
  Judgement judgement{std::string(target.scene) + ": " + tolerance_percent(target.error) +
                      (is_relative ? " point by point (relative RMS)" : "") + " within " + figure(target.yardsticks) +
                      " yardsticks"};
  if (!held) return judgement;
  const auto groups = of(held->groups, Contender::alvor);
  const auto reached = cost_to_reach(is_relative ? relative_error_by_cpu(groups) : error_by_cpu(groups), target.error);
  judgement.measured = cost_text(reached, yardstick_s);
  judgement.verdict = at_most(reached, target.yardsticks * yardstick_s);
  return judgement;
}

void judge_speed(Judgement& judgement, const std::optional<Comparison>& comparison, double times) {
  if (!comparison) return;
  judgement.verdict = Verdict::missed;
  judgement.measured = "Alvor does not reach " + percent(comparison->error);
  if (!comparison->ours) return;
  judgement.measured = (comparison->ours->at_most ? "at least " : "") + plain(comparison->times_faster()) + " times, at " +
                       percent(comparison->error) + ": " + plain(comparison->theirs_s) + " s to " +
                       plain(comparison->ours->cost) + " s";
  if (comparison->times_faster() >= times) judgement.verdict = Verdict::met;
  if (comparison->is_extrapolated) judgement.note = "path tracing extrapolated";
}

Judgement judge_path_tracing(const SceneContest* cornell) {
  Judgement judgement{"Cornell box: at least " + figure(faster_than_path_tracing) + " times faster than path tracing " +
                      "10 000 points to " + tolerance_percent(path_tracing_error)};
  if (cornell)
    judge_speed(judgement, with_path_tracing(cornell->groups, cornell->truth.drawn, path_tracing_error),
                faster_than_path_tracing);
  return judgement;
}

Judgement judge_fixed_mesh(const SceneContest* cornell) {
  Judgement judgement{"Cornell box: at least " + figure(faster_than_fixed_mesh) +
                      " times faster than textbook shooting at the best error that it reaches"};
  if (cornell) judge_speed(judgement, with_fixed_mesh(cornell->groups), faster_than_fixed_mesh);
  return judgement;
}

/// Returns the error of the run with the median error.
Confidence middle_error(const RunGroup& group) {
  std::vector<MeasuredRun> runs = group.runs;
  std::ranges::sort(runs, {}, [](const MeasuredRun& run) { return run.nrmse.value; });
  return runs[(runs.size() - 1) / 2].nrmse;
}

Judgement judge_tolerance(const SceneContest* held, std::string_view name) {
  Judgement judgement = held ? keeps_tolerance(held->groups, tolerance_kept) : Judgement{};
  judgement.aim = std::string(name) + ": error at most " + tolerance_percent(tolerance_kept) + " at that tolerance";
  return judgement;
}

Judgement judge_leaves(const SceneContest* held) {
  Judgement judgement{std::string(slope_scene) + ": at most " + plain(most_leaves) + " leaves at " + tolerance_percent(most_leaves_at)};
  if (!held) return judgement;
  const auto ours = of(held->groups, Contender::alvor);
  const auto group = std::ranges::find(ours, most_leaves_at, &RunGroup::setting);
  if (group == ours.end()) return judgement;
  judgement.measured = plain(group->leaves().median);
  judgement.verdict = group->leaves().median <= most_leaves ? Verdict::met : Verdict::missed;
  return judgement;
}

std::vector<CurvePoint> part_for_slope(std::vector<CurvePoint> curve) {
  std::erase_if(curve, [](const CurvePoint& point) { return point.error > slope_from; });
  return curve;
}

ThreadGain gain_over_all(std::span<const SceneContest> contests) {
  ThreadGain sum;
  for (const SceneContest& held : contests) {
    const ThreadGain gain = gain_of_two_threads(held.groups);
    sum.one_s += gain.one_s, sum.two_s += gain.two_s;
  }
  return sum;
}

}  // namespace

Judgement judge_slope(std::span<const CurvePoint> curve) {
  Judgement judgement{std::string(slope_scene) + ": slope of log error against log time at most " + figure(slope_wanted)};
  if (curve.size() < 2) return judgement;
  const CurvePoint &first = curve.front(), &last = curve.back();
  const double slope = std::log(last.error / first.error) / std::log(last.cost / first.cost);
  judgement.measured = figure(slope, 2) + ", from " + percent(first.error) + " to " + percent(last.error);
  judgement.verdict = slope <= slope_wanted ? Verdict::met : Verdict::missed;
  return judgement;
}

Judgement judge_estimates(std::string_view solves, std::span<const double> ratios) {
  Judgement judgement{"Estimate over truth within " + figure(estimate_close) + " times in " + tolerance_percent(most_close) +
                      " of the solves " + std::string(solves) + ", and never beyond " + figure(estimate_limit) + " times"};
  if (ratios.empty()) return judgement;
  const auto within = [&](double factor) {
    return std::ranges::count_if(ratios, [&](double ratio) { return ratio >= 1 / factor && ratio <= factor; });
  };
  const auto count = static_cast<double>(ratios.size());
  const auto close = within(estimate_close), allowed = within(estimate_limit);
  judgement.measured = std::to_string(close) + " of " + std::to_string(ratios.size()) + " within " + figure(estimate_close) +
                       " times, " + std::to_string(ratios.size() - static_cast<std::size_t>(allowed)) + " beyond " +
                       figure(estimate_limit) + " times";
  const bool is_met = static_cast<double>(close) >= most_close * count && static_cast<std::size_t>(allowed) == ratios.size();
  judgement.verdict = is_met ? Verdict::met : Verdict::missed;
  return judgement;
}

Judgement judge_memory(std::uint64_t bytes) {
  Judgement judgement{"A room of about 420 faces is solved in less than " + figure(most_memory_mb) +
                      " MB, with no option but the scene"};
  if (bytes == 0) return judgement;
  const double megabytes = static_cast<double>(bytes) / 1e6;
  judgement.measured = plain(megabytes) + " MB";
  judgement.verdict = megabytes < most_memory_mb ? Verdict::met : Verdict::missed;
  return judgement;
}

Judgement judge_rises(std::uint64_t rises, std::uint64_t steps) {
  Judgement judgement{"The estimate of a published step is more than " + figure(MeasuredRun::far_above) +
                      " times that of the step before in less than " +
                      tolerance_percent(most_rises) + " of the steps"};
  if (steps == 0) return judgement;
  judgement.measured = std::to_string(rises) + " of " + std::to_string(steps);
  judgement.verdict = static_cast<double>(rises) < most_rises * static_cast<double>(steps) ? Verdict::met : Verdict::missed;
  return judgement;
}

Judgement judge_told_errors(std::span<const double> within_two) {
  Judgement judgement{"Truth within two of the told errors at " + figure(100 * least_within_two) + " to " +
                      tolerance_percent(most_within_two) + " of the points whose truth is known to a fifth, in every solve"};
  if (within_two.empty()) return judgement;
  const Spread spread = spread_of({within_two.begin(), within_two.end()});
  judgement.measured = percent(spread);
  const bool is_met = spread.low >= least_within_two && spread.high <= most_within_two;
  judgement.verdict = is_met ? Verdict::met : Verdict::missed;
  return judgement;
}

std::string_view text(Verdict verdict) {
  switch (verdict) {
    case Verdict::met: return "met";
    case Verdict::missed: return "**missed**";
    case Verdict::not_measured: return "not measured";
  }
  return "unknown";
}

Verdict at_most(const std::optional<Reached>& cost, double limit) {
  return cost && cost->cost <= limit ? Verdict::met : Verdict::missed;
}

Judgement keeps(const Confidence& error, double limit) {
  Judgement judgement;
  judgement.measured = percent(error.value) + ", 95 %: " + plain(100 * error.low) + " to " + plain(100 * error.high);
  judgement.verdict = error.value <= limit ? Verdict::met : Verdict::missed;
  if (error.low <= limit && limit < error.high) judgement.note = "the interval holds " + tolerance_percent(limit);
  return judgement;
}

Judgement keeps_tolerance(std::span<const RunGroup> groups, double tolerance) {
  const auto ours = of(groups, Contender::alvor);
  const auto group = std::ranges::find(ours, tolerance, &RunGroup::setting);
  if (group == ours.end()) {
    if (ours.empty() || ours.back().is_done()) return {};
    const std::string measured =
        "out of time at " + tolerance_percent(ours.back().setting) + ", with " + percent(ours.back().nrmse().median);
    return {"", measured, Verdict::missed};
  }
  Judgement judgement = keeps(middle_error(*group), tolerance);
  if (group->is_done()) return judgement;
  judgement.verdict = Verdict::missed;
  judgement.note = "out of time before its estimate was within the tolerance";
  return judgement;
}

Judgement judge_thread_gain(double one_s, double two_s, double machine_gain) {
  Judgement judgement{"Two threads halve the wall time (" + figure(halved) + " times faster or more), all solves together"};
  if (!(two_s > 0)) return judgement;
  judgement.measured = plain(one_s / two_s) + " times: " + plain(one_s) + " s to " + plain(two_s) + " s";
  judgement.verdict = one_s >= halved * two_s ? Verdict::met : Verdict::missed;
  if (machine_gain >= halved || judgement.verdict == Verdict::met) return judgement;
  judgement.verdict = Verdict::not_measured;
  judgement.note = "the machine was busy: path tracing gained " + plain(machine_gain) + " times";
  return judgement;
}

std::vector<Judgement> judge(std::span<const SceneContest> contests, double yardstick_s, double machine_gain) {
  const SceneContest* cornell = find(contests, "cornell_box");
  std::vector<Judgement> judgements;
  for (const TimeTarget& target : time_targets)
    judgements.push_back(judge_time(find(contests, target.scene), target, yardstick_s));
  judgements.push_back(judge_path_tracing(cornell));
  judgements.push_back(judge_fixed_mesh(cornell));
  for (const char* name : tolerance_scenes) judgements.push_back(judge_tolerance(find(contests, name), name));
  const SceneContest* sloped = find(contests, slope_scene);
  judgements.push_back(
      judge_slope(sloped ? part_for_slope(error_by_cpu(of(sloped->groups, Contender::alvor))) : std::vector<CurvePoint>{}));
  judgements.push_back(judge_leaves(sloped));
  std::vector<double> ratios, of_stopped, within_two;
  std::uint64_t rises = 0, steps = 0;
  for (const SceneContest& held : contests) {
    std::ranges::copy(estimate_ratios(held.runs), std::back_inserter(ratios));
    std::ranges::copy(estimate_ratios_of_stopped(held.runs), std::back_inserter(of_stopped));
    for (const MeasuredRun& run : held.runs) {
      if (run.contender != Contender::alvor) continue;
      rises += run.rises, steps += run.steps;
      if (run.threads == 1 && run.within_two == run.within_two) within_two.push_back(run.within_two);
    }
  }
  judgements.push_back(judge_estimates("that reached their tolerance", ratios));
  judgements.push_back(judge_estimates("that a time limit ended", of_stopped));
  judgements.push_back(judge_told_errors(within_two));
  judgements.push_back(judge_rises(rises, steps));
  for (Judgement (*judge_limits)(std::span<const SceneContest>) : {judge_overtime, judge_more_time, judge_mesh_limits})
    judgements.push_back(judge_limits(contests));
  const ThreadGain gain = gain_over_all(contests);
  judgements.push_back(judge_thread_gain(gain.one_s, gain.two_s, machine_gain));
  return judgements;
}

}  // namespace alvor::bench
