#include "bench/error_vs_time/contest/measured_run.h"

#include "bench/error_vs_time/contest/figures.h"

#include <algorithm>

namespace alvor::bench {

namespace {

template <class Value>
Spread spread_over(const RunGroup& group, Value value) {
  std::vector<double> values;
  for (const MeasuredRun& run : group.runs) values.push_back(value(run));
  return spread_of(std::move(values));
}

bool belongs(const RunGroup& group, const MeasuredRun& run) {
  return group.contender == run.contender && group.setting == run.setting && group.threads == run.threads;
}

/// Returns a cell of the table, which is empty if the number is unknown.
std::string cell(double number) { return ',' + (number == number ? figure(number) : std::string()); }

std::string csv_line(const MeasuredRun& run) {
  std::string line = run.scene + ',' + std::string(text(run.contender)) + ',' + figure(run.setting) + ',' +
                     std::to_string(run.threads) + ',' + std::to_string(run.seed);
  for (const double number : {run.cpu_s, run.wall_s}) line += ',' + figure(number);
  for (const std::uint64_t count : {run.rays, run.leaves}) line += ',' + (count ? std::to_string(count) : std::string());
  for (const double number : {run.estimated, run.nrmse.value, run.nrmse.low, run.nrmse.high, run.relative_rms, run.within_two})
    line += cell(number);
  line += run.is_done ? ",yes" : ",no";
  for (const std::uint64_t count : {run.steps, run.rises}) line += run.steps > 0 ? ',' + std::to_string(count) : ",";
  return line + '\n';
}

}  // namespace

std::string_view text(Contender contender) {
  switch (contender) {
    case Contender::alvor: return "auto";
    case Contender::gather: return "gather";
    case Contender::shoot: return "shoot";
    case Contender::sorted: return "sorted";
    case Contender::overshoot: return "overshoot";
    case Contender::fixed_mesh: return "fixed mesh";
    case Contender::path_tracing: return "path tracing";
    case Contender::no_part: return "no part";
    case Contender::exact_shadows_alone: return "exact shadows alone";
    case Contender::guided_rays_alone: return "guided rays alone";
    case Contender::slabs_alone: return "slabs alone";
    case Contender::unseen_places_alone: return "unseen places alone";
    case Contender::no_exact_shadows: return "all but exact shadows";
    case Contender::no_guided_rays: return "all but guided rays";
    case Contender::no_slabs: return "all but slabs";
    case Contender::no_unseen_places: return "all but unseen places";
    case Contender::until_time: return "auto until a time";
    case Contender::to_depth: return "auto to a depth";
    case Contender::sorted_to_depth: return "sorted to a depth";
    case Contender::to_leaves: return "auto to a number of leaves";
  }
  return "unknown";
}

bool lacks_parts(Contender contender) { return std::ranges::count(with_parts_left_out, contender) > 0; }

std::string runs_csv(std::span<const MeasuredRun> runs) {
  std::string csv =
      "scene,contender,setting,threads,seed,cpu_s,wall_s,rays,leaves,estimated_nrmse,nrmse,nrmse_low,nrmse_high,relative_rms,"
      "within_two_told,done,steps,rises\n";
  for (const MeasuredRun& run : runs) csv += csv_line(run);
  return csv;
}

Spread RunGroup::cpu_s() const {
  return spread_over(*this, [](const MeasuredRun& run) { return run.cpu_s; });
}
Spread RunGroup::wall_s() const {
  return spread_over(*this, [](const MeasuredRun& run) { return run.wall_s; });
}
Spread RunGroup::nrmse() const {
  return spread_over(*this, [](const MeasuredRun& run) { return run.nrmse.value; });
}
Spread RunGroup::relative_rms() const {
  return spread_over(*this, [](const MeasuredRun& run) { return run.relative_rms; });
}
Spread RunGroup::estimated() const {
  return spread_over(*this, [](const MeasuredRun& run) { return run.estimated; });
}
Spread RunGroup::rays() const {
  return spread_over(*this, [](const MeasuredRun& run) { return static_cast<double>(run.rays); });
}
Spread RunGroup::leaves() const {
  return spread_over(*this, [](const MeasuredRun& run) { return static_cast<double>(run.leaves); });
}
bool RunGroup::is_done() const { return std::ranges::all_of(runs, &MeasuredRun::is_done); }

std::vector<RunGroup> grouped(std::span<const MeasuredRun> runs) {
  std::vector<RunGroup> groups;
  for (const MeasuredRun& run : runs) {
    auto group = std::ranges::find_if(groups, [&](const RunGroup& candidate) { return belongs(candidate, run); });
    if (group == groups.end()) group = groups.insert(group, {run.contender, run.setting, run.threads, {}});
    group->runs.push_back(run);
  }
  return groups;
}

std::vector<RunGroup> of(std::span<const RunGroup> groups, Contender contender, int threads) {
  std::vector<RunGroup> chosen;
  std::ranges::copy_if(groups, std::back_inserter(chosen),
                       [&](const RunGroup& group) { return group.contender == contender && group.threads == threads; });
  return chosen;
}

std::vector<CurvePoint> error_by_cpu(std::span<const RunGroup> groups) {
  std::vector<CurvePoint> curve;
  for (const RunGroup& group : groups) curve.push_back({group.cpu_s().median, group.nrmse().median});
  return curve;
}

std::vector<CurvePoint> relative_error_by_cpu(std::span<const RunGroup> groups) {
  std::vector<CurvePoint> curve;
  for (const RunGroup& group : groups) curve.push_back({group.cpu_s().median, group.relative_rms().median});
  return curve;
}

}  // namespace alvor::bench
