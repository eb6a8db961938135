// Writes the section about one scene.

#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/page/page_sections.h"

#include <algorithm>

namespace alvor::bench {

namespace {

std::string mark_of(const RunGroup& group) { return group.is_done() ? "" : " \\*"; }

std::string yardsticks(const RunGroup& group, double yardstick_s) { return plain(group.cpu_s().median / yardstick_s); }

std::string two_threads(std::span<const RunGroup> two, const RunGroup& one) {
  const auto same = std::ranges::find(two, one.setting, &RunGroup::setting);
  if (same == two.end()) return "-";
  return plain(same->wall_s().median) + mark_of(*same) + ", " + plain(one.wall_s().median / same->wall_s().median) + " times";
}

std::string tolerance_table(const SceneContest& held, double yardstick_s) {
  const auto two = of(held.groups, Contender::alvor, 2);
  std::string table = table_head({"tolerance", "true nRMSE", "estimated", "estimated / true", "rays", "leaves", "CPU s",
                                  "yardsticks", "wall s", "two threads: wall s"});
  for (const RunGroup& one : of(held.groups, Contender::alvor))
    table +=
        table_row({tolerance_percent(one.setting) + mark_of(one), percent(one.nrmse()), percent(one.estimated().median),
                   plain(one.estimated().median / one.nrmse().median), compact(one.rays().median), compact(one.leaves().median),
                   plain(one.cpu_s()), yardsticks(one, yardstick_s), plain(one.wall_s().median), two_threads(two, one)});
  return table;
}

std::string setting_of(const RunGroup& group) {
  if (group.contender == Contender::fixed_mesh) return "longest side / " + figure(group.setting);
  if (group.contender == Contender::path_tracing) return figure(group.setting) + " paths a point";
  return tolerance_percent(group.setting);
}

std::string row_of(const RunGroup& group, double yardstick_s) {
  const bool has_estimate = group.contender != Contender::fixed_mesh && group.contender != Contender::path_tracing;
  const double rays = group.rays().median, leaves = group.leaves().median;
  return table_row({std::string(text(group.contender)), setting_of(group) + mark_of(group), percent(group.nrmse()),
                    has_estimate ? percent(group.estimated().median) : "-", rays > 0 ? compact(rays) : "-",
                    leaves > 0 ? compact(leaves) : "-", plain(group.cpu_s()), yardsticks(group, yardstick_s)});
}

std::string others_table(const SceneContest& held, double yardstick_s) {
  // Those after path tracing have sections of their own: what parts bring, and limits.
  const auto is_other = [](const RunGroup& group) {
    return group.contender != Contender::alvor && group.contender <= Contender::path_tracing;
  };
  if (std::ranges::none_of(held.groups, is_other)) return "";
  std::string table = "\nThe others. Path tracing at " + std::to_string(held.truth.drawn) + " points:\n\n" + table_head({"program", "setting", "true nRMSE", "estimated", "rays", "leaves", "CPU s", "yardsticks"});
  for (const RunGroup& group : held.groups)
    if (is_other(group)) table += row_of(group, yardstick_s);
  return table;
}

}  // namespace

std::string scene_section(const SceneContest& held, double yardstick_s) {
  const std::string& name = held.settings.name;
  return "## " + name + "\n\n![" + name + ": error against CPU seconds and rays](error-vs-time/" + name + ".png)\n\n" +
         tolerance_table(held, yardstick_s) + others_table(held, yardstick_s) + "\n";
}

}  // namespace alvor::bench
