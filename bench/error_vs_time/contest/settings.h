#pragma once
// Settings of the measurements.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace alvor::bench {

struct SceneSettings {
  std::string name;                         ///< name of the scene's file, without .obj
  std::vector<double> tolerances;           ///< tolerances for the default strategy, from large to small
  std::vector<double> strategy_tolerances;  ///< tolerances for the other strategies
  std::vector<int> fixed_mesh_cells;        ///< see FixedMeshOptions::cells
  std::vector<std::uint64_t> traced_paths;  ///< paths per point, for path tracing as a contender
  std::size_t truth_points = 10'000;
  std::uint64_t truth_paths = 3200;  ///< paths per point
  double time_limit_s = 0;           ///< limit for one solve; 0: that of Settings
  double parts_tolerance = 0;        ///< one of `tolerances`, at which solves leave out parts; 0: none does
};

struct Settings {
  std::vector<SceneSettings> scenes;
  std::filesystem::path scene_folder = "scenes", made_scene_folder = "out/error_vs_time/scenes";  ///< made by the script
  std::filesystem::path alvor = "build/release/bin/alvor";  ///< the command line, whose memory is measured
  std::filesystem::path truth_folder = "out/error_vs_time/truth", curve_folder = "out/error_vs_time";
  std::filesystem::path page = "docs/error-vs-time.md", figure_folder = "docs/error-vs-time";
  int seeds = 3;
  double time_limit_s = 25;        ///< limit for one solve: more than the 30 yardsticks that a target allows
  double fixed_mesh_limit_s = 90;  ///< limit for one run of textbook shooting, which is not repeated
  std::vector<double> time_limits{0.5, 1, 2, 4, 8};           ///< seconds, increasing, after which solves of each scene are stopped
  std::vector<double> depth_limits{2, 4, 6}, leaf_limits{1000, 10'000};  ///< of scenes whose parts are left out in turn, too
  double long_run_s = 6;           ///< runs that take longer are not repeated with other seeds
  std::uint64_t truth_seed = 20'000;
  bool is_trial = false;  ///< only solves by auto on one thread, and no page
};

/// Returns the settings that the command line asks for. Ends the program after --help and on errors.
Settings read_settings(int count, char** arguments);

}  // namespace alvor::bench
