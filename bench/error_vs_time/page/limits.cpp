#include "bench/error_vs_time/page/limits.h"

#include "bench/error_vs_time/contest/contenders.h"
#include "bench/error_vs_time/contest/figures.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace alvor::bench {

namespace {

constexpr double overtime_share = 0.02, overtime_s = 0.3;  // the larger of both is allowed
constexpr double noise_of_error = 1.1;                     // by which errors of equal solves with different seeds may differ

double overtime(const RunGroup& group) { return group.wall_s().median - group.setting; }

/// Returns the solves without a limit to their mesh that are compared with those that have it, with the same seeds; nothing if
/// there are none, or one was stopped by a limit.
std::optional<RunGroup> without_limit(const SceneContest& held, const RunGroup& limited) {
  const bool is_sorted = limited.contender == Contender::sorted_to_depth;
  auto groups = of(held.groups, is_sorted ? Contender::sorted : Contender::alvor);
  const auto found = std::ranges::find(groups, tolerance_of_limited_meshes, &RunGroup::setting);
  if (found == groups.end()) return std::nullopt;
  const auto has_seed = [&](std::uint64_t seed) { return std::ranges::count(limited.runs, seed, &MeasuredRun::seed) > 0; };
  std::erase_if(found->runs, [&](const MeasuredRun& run) { return !has_seed(run.seed); });
  if (found->runs.empty() || !found->is_done()) return std::nullopt;
  return std::move(*found);
}

/// Counts the solves, or steps between them, that a judgement looks at, and those of them that are as they should be.
struct Count {
  std::size_t fine = 0, all = 0;
  void add(bool is_fine) { fine += is_fine, ++all; }
};

/// Returns the judgement that all should be fine; `more` is said after the count. Not measured if nothing was counted.
Judgement judgement_of(const std::string& aim, const Count& count, const std::string& more = "") {
  if (count.all == 0) return {aim};
  return {aim, std::to_string(count.fine) + " of " + std::to_string(count.all) + more,
          count.fine == count.all ? Verdict::met : Verdict::missed};
}

/// Calls body(limited, unlimited) for each solve with a limit to its mesh.
template <class Body>
void for_each_limited_mesh(const SceneContest& held, Body&& body) {
  for (const Contender contender : with_mesh_limits)
    for (const RunGroup& limited : of(held.groups, contender))
      if (const auto unlimited = without_limit(held, limited)) body(limited, *unlimited);
}

std::string cost_of(const RunGroup& group) {
  return percent(group.nrmse().median) + " in " + plain(group.cpu_s().median) + " s, " + compact(group.rays().median) +
         " rays, " + compact(group.leaves().median) + " leaves";
}

std::string limit_of(const RunGroup& group) {
  if (group.contender == Contender::to_leaves) return "--max-elements " + figure(group.setting);
  const std::string sorted = group.contender == Contender::sorted_to_depth ? "--strategy sorted " : "";
  return sorted + "--max-depth " + figure(group.setting);
}

std::string time_table(const Measurements& measured) {
  std::set<double> limits;
  for (const SceneContest& held : measured.contests)
    for (const RunGroup& group : of(held.groups, Contender::until_time)) limits.insert(group.setting);
  if (limits.empty()) return "";
  std::vector<std::string> heads{"scene"};
  for (const double limit : limits) heads.push_back(figure(limit) + " s");
  std::string table = table_head(heads);
  for (const SceneContest& held : measured.contests) {
    std::vector<std::string> cells{held.settings.name};
    const auto groups = of(held.groups, Contender::until_time);
    for (const double limit : limits) {
      const auto group = std::ranges::find(groups, limit, &RunGroup::setting);
      cells.push_back(group == groups.end() ? ""
                                            : percent(group->nrmse().median) + " (" + percent(group->estimated().median) + "), " +
                                                  plain(group->wall_s().median) + " s");
    }
    table += table_row(cells);
  }
  return table + '\n';
}

std::string mesh_table(const Measurements& measured) {
  std::string rows;
  for (const SceneContest& held : measured.contests)
    for_each_limited_mesh(held, [&](const RunGroup& limited, const RunGroup& unlimited) {
      rows += table_row({held.settings.name, limit_of(limited), cost_of(limited), cost_of(unlimited)});
    });
  return rows.empty() ? "" : table_head({"scene", "limit", "with it", "without"}) + rows + '\n';
}

}  // namespace

Judgement judge_overtime(std::span<const SceneContest> contests) {
  Count kept;
  double most = 0;
  for (const SceneContest& held : contests)
    for (const RunGroup& group : of(held.groups, Contender::until_time)) {
      kept.add(overtime(group) <= std::max(overtime_s, overtime_share * group.setting));
      most = std::max(most, overtime(group));
    }
  return judgement_of("Time limits are kept within " + tolerance_percent(overtime_share) + " or " + figure(overtime_s) + " s",
                      kept, ", at most " + plain(most) + " s longer");
}

Judgement judge_more_time(std::span<const SceneContest> contests) {
  Count no_worse;
  for (const SceneContest& held : contests) {
    const auto groups = of(held.groups, Contender::until_time);
    for (std::size_t n = 1; n < groups.size(); ++n)
      no_worse.add(groups[n].nrmse().median <= noise_of_error * groups[n - 1].nrmse().median);
  }
  return judgement_of("More time never gives a worse answer by more than noise (" + figure(noise_of_error) + " times the error)",
                      no_worse, " steps from one time limit to the next");
}

Judgement judge_mesh_limits(std::span<const SceneContest> contests) {
  Count no_dearer;
  for (const SceneContest& held : contests)
    for_each_limited_mesh(held, [&](const RunGroup& limited, const RunGroup& unlimited) {
      no_dearer.add(limited.rays().median <= unlimited.rays().median);
    });
  return judgement_of("A limit to depth or leaves never makes a solve cast more rays", no_dearer);
}

std::string limits_section(const Measurements& measured) {
  const std::string times = time_table(measured), meshes = mesh_table(measured);
  if (times.empty() && meshes.empty()) return "";
  std::string text = "## Limits\n\n";
  if (!times.empty())
    text +=
        "Solves that `--time-limit` stops, one thread, one seed: the true error, in brackets the estimated one, and the wall "
        "seconds that the solve took.\n\n" +
        times;
  if (!meshes.empty())
    text += "Solves that are asked for " + tolerance_percent(tolerance_of_limited_meshes) +
            " with a limit to their mesh, and without: true error, CPU seconds, rays and leaves.\n\n" + meshes;
  return text;
}

}  // namespace alvor::bench
