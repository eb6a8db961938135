// Writes the section about what each part of the method brings.

#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/page/page_sections.h"

#include <algorithm>

namespace alvor::bench {

namespace {

/// Returns the error and the time of a contender at the tolerance at which parts are left out, and how much both together are.
std::string cell_of(const SceneContest& held, Contender contender) {
  const auto groups = of(held.groups, contender);
  const auto group = std::ranges::find(groups, held.settings.parts_tolerance, &RunGroup::setting);
  if (group == groups.end()) return "-";
  const double error = group->nrmse().median, cpu_s = group->cpu_s().median;
  return percent(error) + " in " + plain(cpu_s) + " s" + (group->is_done() ? "" : " \\*") + "; " +
         plain(1e4 * error * error * cpu_s);
}

std::string row_of(const std::vector<const SceneContest*>& contests, Contender contender, const std::string& name) {
  std::vector<std::string> cells{name};
  for (const SceneContest* held : contests) cells.push_back(cell_of(*held, contender));
  return table_row(cells);
}

}  // namespace

std::string parts_section(const Measurements& measured) {
  std::vector<const SceneContest*> contests;
  for (const SceneContest& held : measured.contests)
    if (held.settings.parts_tolerance > 0) contests.push_back(&held);
  if (contests.empty()) return "";
  std::string text =
      "## What each part brings\n\n"
      "Solves that leave parts of the method out: exact shadows of flat lamps, guided rays, slabs, and unseen places (slivers "
      "between solids and openings of gaps). Each cell has the true error and the CPU seconds (medians over seeds), and after "
      "the "
      "semicolon the squared error (in %) times the seconds: half of that is as good as half of the time, where errors fall with "
      "the root of the time.\n\n";
  std::vector<std::string> heads{"parts"};
  for (const SceneContest* held : contests)
    heads.push_back(held->settings.name + ", asked for " + tolerance_percent(held->settings.parts_tolerance));
  text += table_head(heads) + row_of(contests, Contender::alvor, "all");
  for (const Contender contender : with_parts_left_out) text += row_of(contests, contender, std::string(bench::text(contender)));
  return text + '\n';
}

}  // namespace alvor::bench
