#include "bench/error_vs_time/page.h"

#include "bench/error_vs_time/figures.h"
#include "bench/error_vs_time/page_sections.h"

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
         "True and estimated error of Alvor and of what it is compared with, against CPU seconds and rays. "
         "`scripts/error_vs_time.sh` "
         "measures everything on this page in one run and writes it, figures and verdicts; this one ran on " +
         cores() +
         ".\n\n"
         "**The yardstick** makes times comparable between machines: path tracing 300 points of the Cornell box by 2 000 paths "
         "each, on one "
         "thread. Here it took " +
         plain(measured.yardstick_spread_s()) + " CPU s (median, and the ends of " + std::to_string(measured.yardsticks.size()) +
         " times in the course of the run). Two threads take it " + plain(measured.two_threads_faster()) +
         " times faster: as much as this machine had to give.\n\n";
}

std::string method(const Settings& settings) {
  return "## How it is measured\n\n"
         "- **Error** is the nRMSE of irradiance at random surface points, uniform by area: the RMS difference from the truth "
         "over the mean "
         "truth. Points under or inside solids are left out, and so are those dark in both. A solution is read as `alvor probe` "
         "reads it: the "
         "nearest surface that faces the same way, interpolated in the display mesh. Making that mesh is not part of a solve's "
         "time.\n"
         "- **Truth** is unbiased path tracing; its own variance is taken out of all errors, as `alvor verify` does.\n"
         "- **Alvor** solves in its own process, `--strategy auto` unless another is named. Each row is a solve of its own, from "
         "nothing: the "
         "median of " +
         std::to_string(settings.seeds) + (settings.seeds == 1 ? " seed" : " seeds") +
         ", and in brackets the least and the most. A solve of more than " + plain(settings.long_run_s) +
         " s has one seed; after " + plain(settings.time_limit_s) +
         " s it is stopped, which the tables mark by \\*, and no tighter tolerance is tried. Leaves are "
         "limited to a million.\n"
         "- **Textbook strategies**: `gather`, `shoot`, `sorted` and `overshoot` differ in the order in which light is "
         "distributed and share "
         "the rows and the refinement with `auto` ([strategies](strategies.md)).\n"
         "- **Textbook shooting on a fixed mesh** shares nothing with the solver but the casting of rays, sixteen at a time: "
         "each face is cut "
         "evenly into elements, no edge longer than the longest side of the scene over 4 to 64; patches of four elements shoot, "
         "the "
         "largest unshot power first, until a thousandth of the emitted power is unshot; a shot sends four shadow rays to each "
         "element, "
         "weighted as small disks, and is dimmed where it would bring more than it had (Cohen, Chen, Wallace & Greenberg 1988; "
         "Wallace, Elmquist & Haines 1989). It runs once, for " +
         plain(settings.fixed_mesh_limit_s) +
         " s at most.\n"
         "- **Path tracing** is that of `alvor verify`, at the same points as the truth with other random numbers. Its rays are "
         "not counted. "
         "Its time is in proportion to the points; where tables speak of 10 000 points, and in the plots, it is scaled so.\n"
         "- Times are CPU seconds of one thread unless wall seconds are said. Where a table says *to reach*, the error is "
         "interpolated between "
         "neighbouring settings on a straight line in log-log.\n\n"
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

std::string page(const Measurements& measured, const Settings& settings, const std::string& tried) {
  std::string text = head(measured) + targets_section(measured) + method(settings) + truth_section(measured);
  for (const SceneContest& held : measured.contests) text += scene_section(held, measured.yardstick_s());
  text += estimate_section(measured) + path_tracing_section(measured) + fixed_mesh_section(measured);
  return text + "## Tried and did not pay\n\n" + tried;
}

}  // namespace alvor::bench
