#include "bench/error_vs_time/page/page_sections.h"

#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/page/comparisons.h"
#include "bench/error_vs_time/page/targets.h"

#include <algorithm>
#include <set>

namespace alvor::bench {

namespace {

std::string time_text(double cpu_s, double yardstick_s) {
  return plain(cpu_s) + " s, " + plain(cpu_s / yardstick_s) + " yardsticks";
}

std::string our_time(const Comparison& comparison, double yardstick_s) {
  if (!comparison.ours) return "not reached";
  return (comparison.ours->at_most ? "at most " : "") + time_text(comparison.ours->cost, yardstick_s);
}

std::string times_faster(const Comparison& comparison) {
  if (!comparison.ours) return "-";
  return (comparison.ours->at_most ? "at least " : "") + plain(comparison.times_faster());
}

std::set<double, std::greater<>> all_tolerances(const Measurements& measured) {
  std::set<double, std::greater<>> tolerances;
  for (const SceneContest& held : measured.contests)
    for (const RunGroup& group : of(held.groups, Contender::alvor)) tolerances.insert(group.setting);
  return tolerances;
}

std::string ratio_at(const SceneContest& held, double tolerance) {
  for (const RunGroup& group : of(held.groups, Contender::alvor))
    if (group.setting == tolerance && group.is_done()) {
      const auto ratios = estimate_ratios(group.runs);
      return plain(spread_of(ratios).median);
    }
  return "-";
}

std::string within_text(const std::vector<double>& ratios) {
  return std::to_string(std::ranges::count_if(ratios, is_within_a_factor_of_two)) + " of " + std::to_string(ratios.size());
}

std::string ratio_table(const Measurements& measured) {
  const auto tolerances = all_tolerances(measured);
  std::vector<std::string> heads{"tolerance"};
  for (const double tolerance : tolerances) heads.push_back(tolerance_percent(tolerance));
  heads.insert(heads.end(), {"least", "most", "within a factor of two"});
  std::string table = table_head(heads);
  for (const SceneContest& held : measured.contests) {
    std::vector<std::string> row{held.settings.name};
    for (const double tolerance : tolerances) row.push_back(ratio_at(held, tolerance));
    const auto ratios = estimate_ratios(held.runs);
    const Spread spread = ratios.empty() ? Spread{} : spread_of(ratios);
    row.insert(row.end(), {plain(spread.low), plain(spread.high), within_text(ratios)});
    table += table_row(row);
  }
  return table;
}

}  // namespace

std::string targets_section(const Measurements& measured) {
  std::string text = "## Targets\n\n" + table_head({"aim", "measured", "verdict"});
  auto judgements = judge(measured.contests, measured.yardstick_s(), measured.two_threads_faster().median);
  judgements.push_back(judge_memory(measured.peak_memory));
  for (const Judgement& judgement : judgements)
    text +=
        table_row({judgement.aim, judgement.measured.empty() ? "-" : judgement.measured,
                   std::string(alvor::bench::text(judgement.verdict)) + (judgement.note.empty() ? "" : "; " + judgement.note)});
  return text + '\n';
}

std::string truth_section(const Measurements& measured) {
  std::string text =
      "## The truth\n\nThe truth has an error of its own. *Standard error* is its RMS over all points, divided by the mean "
      "irradiance, as the nRMSE is; *point by point* divides the error of each point by the irradiance of that point."
      " Points whose truth has a standard error above a fifth of the truth are not compared with told errors: fewer than about 25 "
      "paths bring light there, so that most of these truths are too low, and so are their variances. These are half of the points "
      "of enfilade, a fifth of those of louvred_room, and at most 8 % of those of every other scene.\n\n" +
      table_head({"scene", "faces", "points", "hidden", "paths each", "mean, W/m2", "standard error", "point by point", "CPU s"});
  for (const SceneContest& held : measured.contests) {
    const TruthSummary& truth = held.truth;
    text += table_row({held.settings.name, std::to_string(held.faces), std::to_string(truth.drawn), std::to_string(truth.hidden),
                       std::to_string(truth.paths), plain(truth.mean), percent(truth.error), percent(truth.relative_error),
                       plain(truth.cpu_s) + (truth.was_kept ? ", in an earlier run" : "")});
  }
  return text + '\n';
}

std::string estimate_section(const Measurements& measured) {
  std::vector<double> all;
  for (const SceneContest& held : measured.contests) std::ranges::copy(estimate_ratios(held.runs), std::back_inserter(all));
  if (all.empty()) return "";
  const Spread spread = spread_of(all);
  return "## What the estimate is worth\n\n![estimated against true error](error-vs-time/estimates.png)\n\n"
         "The table divides the estimated error by the true error, for solves by `auto` on one thread that reached their "
         "tolerances: medians over seeds, then the ends over all solves. Below 1, the true error was larger than the "
         "estimate.\n\n" +
         ratio_table(measured) + "\nAll together: " + plain(spread.low) + " to " + plain(spread.high) + ", median " +
         plain(spread.median) + "; " + within_text(all) + " solves are within a factor of two.\n\n";
}

std::string path_tracing_section(const Measurements& measured) {
  std::string text = "## Against path tracing\n\nCPU seconds to reach " + tolerance_percent(path_tracing_error) +
                     ". Path tracing finds the light at 10 000 points, Alvor everywhere. *Extrapolated*: not measured, but "
                     "computed from the most "
                     "paths that were measured; the error falls as one over the square root of the paths.\n\n" +
                     table_head({"scene", "path tracing", "Alvor", "times faster"});
  for (const SceneContest& held : measured.contests) {
    const auto comparison = with_path_tracing(held.groups, held.truth.drawn, path_tracing_error);
    if (!comparison) continue;
    const std::string theirs = time_text(comparison->theirs_s, measured.yardstick_s());
    text += table_row({held.settings.name, theirs + (comparison->is_extrapolated ? ", extrapolated" : ""),
                       our_time(*comparison, measured.yardstick_s()), times_faster(*comparison)});
  }
  return text + '\n';
}

std::string fixed_mesh_section(const Measurements& measured) {
  std::string text =
      "## Against textbook shooting\n\nCPU seconds to the least error that textbook shooting reached on any of its fixed "
      "meshes.\n\n" +
      table_head({"scene", "its least error", "textbook shooting", "Alvor", "times faster"});
  for (const SceneContest& held : measured.contests) {
    const auto comparison = with_fixed_mesh(held.groups);
    if (!comparison) continue;
    text += table_row({held.settings.name, percent(comparison->error), time_text(comparison->theirs_s, measured.yardstick_s()),
                       our_time(*comparison, measured.yardstick_s()), times_faster(*comparison)});
  }
  return text + '\n';
}

}  // namespace alvor::bench
