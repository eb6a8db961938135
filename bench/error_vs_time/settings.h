#pragma once
// What is measured, and how thoroughly.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace alvor::bench {

struct SceneSettings {
  std::string name;                         ///< of its file, without .obj
  std::vector<double> tolerances;           ///< of the default strategy, from loose to tight
  std::vector<double> strategy_tolerances;  ///< of the others
  std::vector<int> fixed_mesh_cells;        ///< see FixedMeshOptions::cells
  std::vector<std::uint64_t> traced_paths;  ///< of each point, by the path tracer as a contender
  std::size_t truth_points = 10'000;
  std::uint64_t truth_paths = 3200;  ///< of each point
};

struct Settings {
  std::vector<SceneSettings> scenes;
  std::filesystem::path scene_folder = "scenes", truth_folder = "out/error_vs_time/truth", curve_folder = "out/error_vs_time";
  std::filesystem::path page = "docs/error-vs-time.md", figure_folder = "docs/error-vs-time";
  int seeds = 3;
  double time_limit_s = 20;        ///< of one solve
  double fixed_mesh_limit_s = 90;  ///< of one run of textbook shooting, which is not repeated
  double long_run_s = 6;           ///< runs that take longer are not repeated with other seeds
  std::uint64_t truth_seed = 20'000;
};

/// What the command line asks for; ends the program where it asks for help or cannot be read.
Settings read_settings(int count, char** arguments);

}  // namespace alvor::bench
