#include "bench/error_vs_time/contest/settings.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstdlib>

namespace alvor::bench {

namespace {

// Noise of the truth is removed from the errors, but a few very wrong points are a matter of chance: with much small furniture,
// more points are better than more paths. Light through doorways is hard to sample and needs both.
std::vector<SceneSettings> all_scenes() {
  const std::vector<double> others{0.05, 0.02}, few{0.1, 0.05, 0.03, 0.02}, more{0.1, 0.05, 0.03, 0.02, 0.015, 0.01},
      gaps{0.05, 0.02};
  const std::vector<std::uint64_t> paths{16, 64, 256}, more_paths{16, 64, 256, 1024};
  return {{"cornell_box",
           {0.1, 0.05, 0.03, 0.02, 0.015, 0.01, 0.007, 0.005},
           {0.05, 0.02, 0.01},
           {8, 16, 32},
           more_paths,
           4000,
           32'000,
           0,
           0.01},
          {"furnished_room", more, others, {8, 16}, paths, 10'000, 3200, 0, 0.02},
          {"slats_and_boxes", more, others, {4, 8}, paths, 10'000, 3200, 0, 0.02},
          {"vault", more, others, {8, 16}, paths, 10'000, 3200, 0, 0.02},
          {"enfilade", more, others, {8, 16, 32, 64}, more_paths, 4000, 32'000, 0, 0.02},
          {"louvred_room", few, others, {8, 16}, paths, 10'000, 12'800},
          {"cabinets", {0.1, 0.05, 0.02}, {}, {}, {}, 4000, 6400},
          {"office_5000", {0.1, 0.05}, {}, {}, {}, 4000, 3200},
          {"office_50000", {0.15, 0.1}, {}, {}, {}, 4000, 3200, 120},
          {"gap_panels", gaps, {}, {}, {}, 4000, 8000, 0, 0.02},
          {"gap_ceiling", gaps, {}, {}, {}, 4000, 8000},
          {"gap_lamp", gaps, {}, {}, {}, 4000, 8000}};
}

struct Wishes {
  std::vector<std::string> only;
  std::size_t points = 0;
  std::uint64_t truth_paths = 0;
  std::vector<double> tolerances;
  bool quick = false;
};

void make_quick(Settings& settings) {
  settings.seeds = 1, settings.time_limit_s = 3, settings.fixed_mesh_limit_s = 5, settings.time_limits = {0.5, 1};
  for (SceneSettings& scene : settings.scenes) {
    scene.truth_points = 500, scene.truth_paths /= 8, scene.time_limit_s = 0;
    if (scene.parts_tolerance > 0) scene.parts_tolerance = 0.02;
    std::erase_if(scene.tolerances, [](double tolerance) { return tolerance < 0.015; });
    std::erase_if(scene.strategy_tolerances, [](double tolerance) { return tolerance < 0.015; });
    std::erase_if(scene.fixed_mesh_cells, [](int cells) { return cells > 16; });
  }
}

void apply(const Wishes& wishes, Settings& settings) {
  const auto is_unwanted = [&](const SceneSettings& scene) { return std::ranges::count(wishes.only, scene.name) == 0; };
  if (!wishes.only.empty()) std::erase_if(settings.scenes, is_unwanted);
  if (wishes.quick) make_quick(settings);
  settings.is_trial = !wishes.tolerances.empty();
  for (SceneSettings& scene : settings.scenes) {
    if (settings.is_trial) scene.tolerances = wishes.tolerances;
    if (wishes.points > 0) scene.truth_points = wishes.points;
    if (wishes.truth_paths > 0) scene.truth_paths = wishes.truth_paths;
  }
}

void add_options(CLI::App& app, Settings& settings, Wishes& wishes) {
  const CLI::Range from_one(std::uint64_t{1}, std::uint64_t{1} << 40);
  std::vector<std::string> names;
  for (const SceneSettings& scene : settings.scenes) names.push_back(scene.name);
  app.add_option("--only", wishes.only, "Scenes to measure (all)")->check(CLI::IsMember(names));
  app.add_option("--points", wishes.points, "Surface points where the truth is found (per scene)")->check(from_one);
  app.add_option("--truth-paths", wishes.truth_paths, "Paths from each of them (per scene)")->check(from_one);
  app.add_option("--seeds", settings.seeds, "Repetitions of each solve (3)")->check(CLI::Range(1, 1000));
  app.add_option("--time-limit", settings.time_limit_s, "Seconds that one solve may take (25)")->check(CLI::PositiveNumber);
  app.add_option("--long-run", settings.long_run_s, "Runs of more seconds are not repeated (6)")->check(CLI::PositiveNumber);
  app.add_option("--truth", settings.truth_folder, "Where truths are kept for the next run (out/error_vs_time/truth)");
  app.add_option("--tolerances", wishes.tolerances, "Only solves by auto at these tolerances on one thread; writes nothing")
      ->check(CLI::Range(1e-6, 1.0));
  app.add_flag("--quick", wishes.quick, "One seed, few points and paths, no tight tolerances");
}

}  // namespace

Settings read_settings(int count, char** arguments) {
  Settings settings;
  settings.scenes = all_scenes();
  Wishes wishes;
  CLI::App app("Measures the error of solves and of what they are compared with against run time, and writes the page about it.");
  add_options(app, settings, wishes);
  try {
    app.parse(count, arguments);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  apply(wishes, settings);
  return settings;
}

}  // namespace alvor::bench
