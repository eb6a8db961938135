#pragma once
// Runs all programs on one scene.

#include "bench/error_vs_time/contest/measured_run.h"
#include "bench/error_vs_time/contest/settings.h"

#include <functional>
#include <vector>

namespace alvor::bench {

struct TruthSummary {
  std::size_t drawn = 0;    ///< points
  std::size_t counted = 0;  ///< number of drawn points that are neither hidden nor dark
  std::size_t hidden = 0;
  std::uint64_t paths = 0;
  double cpu_s = 0;
  bool was_kept = false;
  double mean = 0;            ///< W/m2
  double error = 0;           ///< standard error of the truth: RMS over points / mean
  double relative_error = 0;  ///< RMS over points of standard error / truth
};

struct SceneContest {
  SceneSettings settings;
  std::size_t faces = 0;
  TruthSummary truth;
  std::vector<MeasuredRun> runs;
  std::vector<RunGroup> groups;  ///< `runs` by setting
};

/// Called with a line about each step of the measurement.
using Announce = std::function<void(const std::string&)>;

/// Measures all programs on one scene. Solves longer than settings.long_run_s are not repeated, and after one that ran out of
/// time no smaller tolerance is tried. Throws SceneFileError, FileError.
SceneContest contest(const SceneSettings& scene, const Settings& settings, const Announce& announce);

/// The unit of time that makes machines comparable: path tracing 300 points of the Cornell box with 2000 paths each.
struct Yardstick {
  double cpu_s = 0;               ///< on one thread
  double two_threads_faster = 0;  ///< wall time of one thread over that of two; near 2 if two cores are free
};

/// Measures the yardstick. Throws SceneFileError.
Yardstick time_yardstick(const Settings& settings);

}  // namespace alvor::bench
