#include "bench/error_vs_time/contest/contest.h"

#include "bench/error_vs_time/contest/contenders.h"
#include "bench/error_vs_time/contest/figures.h"
#include "bench/error_vs_time/contest/stopwatch.h"
#include "client/verify/irradiance_estimate.h"
#include "client/verify/surface_points.h"
#include "import/apart/scene_file.h"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace alvor::bench {

namespace {

constexpr std::size_t yardstick_points = 300;
constexpr std::uint64_t yardstick_paths = 2000;

SceneFile read_scene(const Settings& settings, const std::string& name) {
  const auto made = settings.made_scene_folder / (name + ".obj");
  return read_scene_file(std::filesystem::exists(made) ? made : settings.scene_folder / (name + ".obj"));
}

TruthSummary summary_of(const Truth& truth) {
  const ErrorStatistics known = errors_of_itself(truth);
  return {truth.points.size(), known.points,      truth.hidden(),
          truth.paths,         truth.cpu_s,       truth.was_kept,
          known.mean_truth,    known.truth_error, known.relative_truth_error};
}

std::string line_of(const MeasuredRun& run) {
  std::string line = run.scene + ' ' + std::string(text(run.contender)) + ' ' + figure(run.setting) + " threads " +
                     std::to_string(run.threads) + " seed " + std::to_string(run.seed) + ": " + plain(run.cpu_s) +
                     " CPU s, nRMSE " + percent(run.nrmse.value) + ", " + std::to_string(run.leaves) + " leaves, " +
                     std::to_string(run.rays) + " rays";
  if (run.estimated == run.estimated) line += ", estimated " + percent(run.estimated);
  return line + (run.is_done ? "" : ", stopped by a limit");
}

class Rounds {
 public:
  Rounds(const Arena& arena, const Settings& settings, const Announce& announce, std::vector<MeasuredRun>& runs)
      : arena_(arena), settings_(settings), announce_(announce), runs_(runs) {}

  void run() {
    if (settings_.is_trial) return solve_by_tolerance(Contender::alvor, arena_.settings.tolerances, 1);
    for (const int threads : {1, 2}) solve_by_tolerance(Contender::alvor, arena_.settings.tolerances, threads);
    for (const Contender strategy : strategies) solve_by_tolerance(strategy, arena_.settings.strategy_tolerances, 1);
    if (arena_.settings.parts_tolerance > 0)
      for (const Contender without : with_parts_left_out) repeat(without, arena_.settings.parts_tolerance, 1);
    run_with_limits();
    for (const int cells : arena_.settings.fixed_mesh_cells)
      if (!keep(shoot_with(arena_, cells)).is_done) break;
    for (const std::uint64_t paths : arena_.settings.traced_paths) keep(trace_with(arena_, paths));
  }

 private:
  void run_with_limits() {
    const auto solve_each = [&](Contender contender, const std::vector<double>& limits) {
      for (const double limit : limits) keep(solve_with(arena_, contender, limit, 1, 1));
    };
    solve_each(Contender::until_time, settings_.time_limits);
    if (arena_.settings.parts_tolerance == 0) return;
    solve_each(Contender::to_depth, settings_.depth_limits);
    solve_each(Contender::to_leaves, settings_.leaf_limits);
    if (std::ranges::count(arena_.settings.strategy_tolerances, tolerance_of_limited_meshes) > 0)
      solve_each(Contender::sorted_to_depth, settings_.depth_limits);
  }

  const MeasuredRun& keep(MeasuredRun run) {
    runs_.push_back(std::move(run));
    announce_(line_of(runs_.back()));
    return runs_.back();
  }

  void solve_by_tolerance(Contender contender, const std::vector<double>& tolerances, int threads) {
    for (const double tolerance : tolerances)
      if (!repeat(contender, tolerance, threads)) return;
  }

  /// Repeats a solve with several seeds. Returns false if the time limit ended one.
  bool repeat(Contender contender, double tolerance, int threads) {
    for (int seed = 1; seed <= settings_.seeds; ++seed) {
      const MeasuredRun& run = keep(solve_with(arena_, contender, tolerance, threads, static_cast<std::uint64_t>(seed)));
      if (!run.is_done) return false;
      if (run.wall_s > settings_.long_run_s) break;
    }
    return true;
  }

  const Arena& arena_;
  const Settings& settings_;
  const Announce& announce_;
  std::vector<MeasuredRun>& runs_;
};

}  // namespace

SceneContest contest(const SceneSettings& scene, const Settings& settings, const Announce& announce) {
  const SceneFile file = read_scene(settings, scene.name);
  const BaseMesh mesh(file.scene);
  const Truth truth = find_truth(file.scene, scene, settings);
  SceneContest held{scene, file.scene.faces.size(), summary_of(truth), {}, {}};
  announce(scene.name + ": truth of " + std::to_string(held.truth.drawn) + " points, " + std::to_string(truth.paths) +
           " paths each, standard error " + percent(held.truth.error) + ", " + plain(truth.cpu_s) + " CPU s" +
           (truth.was_kept ? ", kept from an earlier run" : ""));
  const double time_limit_s = scene.time_limit_s > 0 ? scene.time_limit_s : settings.time_limit_s;
  const Arena arena{scene, file.scene, mesh, truth, time_limit_s, settings.fixed_mesh_limit_s};
  Rounds(arena, settings, announce, held.runs).run();
  held.groups = grouped(held.runs);
  return held;
}

Yardstick time_yardstick(const Settings& settings) {
  const SceneFile file = read_scene(settings, "cornell_box");
  const auto points = draw_surface_points(file.scene, yardstick_points, 1);
  const auto time = [&](int threads) {
    const Stopwatch watch;
    const PathTracer tracer(file.scene);
    trace_irradiance(tracer, points, {.paths = yardstick_paths, .threads = threads});
    return std::pair(watch.cpu_s(), watch.wall_s());
  };
  const auto [cpu_s, wall_s] = time(1);
  return {cpu_s, wall_s / time(2).second};
}

}  // namespace alvor::bench
