#include "bench/error_vs_time/page/page.h"

#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/page/limits.h"
#include "bench/error_vs_time/page/page_sections.h"

#include <thread>

namespace alvor::bench {

namespace {

std::string cores() {
  const unsigned count = std::thread::hardware_concurrency();
  if (count == 1) return "one core of a server";
  return (count == 2 ? "two" : std::to_string(count)) + " cores of one server";
}

std::string head(const Measurements& measured) {
  return "# Error against run time\n\n"
         "This page shows how large the error of Alvor is after how much time, next to textbook radiosity and path tracing, and "
         "whether the targets are met. `scripts/error_vs_time.sh` measures everything in one run and writes this page, figures "
         "and "
         "verdicts. This run was on " +
         cores() +
         ".\n\n"
         "**The yardstick** makes times comparable between machines: it is the time to trace 2 000 paths from each of 300 points "
         "of "
         "the Cornell box, on one thread. Here it took " +
         plain(measured.yardstick_spread_s()) + " CPU s (the median, and the ends, of " +
         std::to_string(measured.yardsticks.size()) + " times in the course of the run). Two threads trace the paths " +
         plain(measured.two_threads_faster()) + " times faster than one: a second thread cannot bring more on this machine.\n\n";
}

/// Returns the limits of scenes that have their own, to be put after the limit of the others.
std::string own_limits(const Settings& settings) {
  std::string limits;
  for (const SceneSettings& scene : settings.scenes)
    if (scene.time_limit_s > 0) limits += " (" + scene.name + ": " + plain(scene.time_limit_s) + " s)";
  return limits;
}

std::string method(const Settings& settings) {
  return "## How it is measured\n\n"
         "- **Error** is the nRMSE of irradiance at random surface points, uniform by area: the RMS difference from the truth, "
         "divided by the mean truth. Points under or inside solids are left out, and so are points that are dark in both. A "
         "solution is read as `alvor probe` reads it: the nearest surface that faces the same way, interpolated in the display "
         "mesh. Making that mesh does not count as time of the solve.\n"
         "- **Truth** is unbiased path tracing. Its own variance is taken out of all errors, as `alvor verify` does.\n"
         "- **Alvor** solves in its own process, by `--strategy auto` unless another strategy is named. Each line of a table is "
         "a "
         "new solve from the beginning: the median of " +
         std::to_string(settings.seeds) + (settings.seeds == 1 ? " seed" : " seeds") +
         ", and in brackets the least and the most. A solve that takes more than " + plain(settings.long_run_s) +
         " s is run with one seed. After " + plain(settings.time_limit_s) + " s" + own_limits(settings) +
         " it is stopped; the tables mark that by \\*, and no tighter tolerance is tried. Leaves are limited to a million.\n"
         "- **Textbook strategies**: `gather`, `shoot`, `sorted` and `overshoot` distribute light in another order than `auto`. "
         "Rows "
         "and refinement are the same ([strategies](strategies.md)).\n"
         "- **Textbook shooting on a fixed mesh** shares only the casting of rays with the solver, sixteen at a time. Each face "
         "is "
         "cut evenly into elements, so that no edge is longer than the longest side of the scene over 4 to 64. Patches of four "
         "elements shoot, the largest unshot power first, until a thousandth of the emitted power is unshot. A shot sends four "
         "shadow rays to each element, weighted as small disks, and is dimmed where it would bring more than it had (Cohen, "
         "Chen, "
         "Wallace & Greenberg 1988; Wallace, Elmquist & Haines 1989). It runs once, for " +
         plain(settings.fixed_mesh_limit_s) +
         " s at most.\n"
         "- **Path tracing** is that of `alvor verify`, at the same points as the truth, with other random numbers. Its rays are "
         "not "
         "counted. Its time is in proportion to the points; where a table says 10 000 points, and in the plots, it is scaled to "
         "10 000 points.\n"
         "- **Times** are CPU seconds of one thread, unless wall seconds are said. Where a table says *to reach*, the error is "
         "interpolated between neighbouring settings, on a straight line in log-log.\n\n"
         "All runs: [runs.csv](error-vs-time/runs.csv).\n\n";
}

}  // namespace

Spread Measurements::yardstick_spread_s() const {
  std::vector<double> times;
  for (const Yardstick& yardstick : yardsticks) times.push_back(yardstick.cpu_s);
  return spread_of(std::move(times));
}

Spread Measurements::two_threads_faster() const {
  std::vector<double> gains;
  for (const Yardstick& yardstick : yardsticks) gains.push_back(yardstick.two_threads_faster);
  return spread_of(std::move(gains));
}

std::string page(const Measurements& measured, const Settings& settings, const std::string& missed, const std::string& tried) {
  std::string text = head(measured) + targets_section(measured) + "## What the missed ones would take\n\n" + missed + '\n' +
                     method(settings) + truth_section(measured);
  for (const SceneContest& held : measured.contests) text += scene_section(held, measured.yardstick_s());
  text += parts_section(measured) + limits_section(measured) + estimate_section(measured) + path_tracing_section(measured) +
          fixed_mesh_section(measured);
  return text + "## Tried and did not pay\n\n" + tried;
}

}  // namespace alvor::bench
