#pragma once
// One program against another, at the same error.

#include "bench/error_vs_time/contest.h"

#include <optional>

namespace alvor::bench {

/// How long the default strategy and another program take, on one thread, to one error.
struct Comparison {
  double error = 0;
  std::optional<Reached> ours;  ///< CPU s; nothing if never that good
  double theirs_s = 0;
  bool is_extrapolated = false;  ///< theirs

  /// At least that many, if ours is at most. Requires: ours.
  double times_faster() const { return theirs_s / ours->cost; }
};

/// Textbook shooting at the least error of all its meshes. Nothing if it did not run.
std::optional<Comparison> with_fixed_mesh(std::span<const RunGroup> groups);

inline constexpr double points_of_a_scene = 10'000;  ///< as many as a solution is worth
inline constexpr double path_tracing_error = 0.01;   ///< that it is compared at

/// Path tracing of points_of_a_scene points, by time per point of the `drawn` ones that it was measured at. Nothing if it did not
/// run.
std::optional<Comparison> with_path_tracing(std::span<const RunGroup> groups, std::size_t drawn, double error);

/// Wall seconds of all settings that one and two threads finished.
struct ThreadGain {
  double one_s = 0, two_s = 0;
  double times_faster() const { return one_s / two_s; }
};
ThreadGain gain_of_two_threads(std::span<const RunGroup> groups);

/// Estimated over true error of the default strategy's runs on one thread that reached their tolerances.
std::vector<double> estimate_ratios(std::span<const MeasuredRun> runs);

}  // namespace alvor::bench
