#pragma once
// Compares Alvor's time with other programs' at the same error.

#include "bench/error_vs_time/contest/contest.h"

#include <optional>

namespace alvor::bench {

/// The times that Alvor's default strategy and another program need on one thread for the same error.
struct Comparison {
  double error = 0;
  std::optional<Reached> ours;  ///< CPU s; empty if that error is never reached
  double theirs_s = 0;
  bool is_extrapolated = false;  ///< whether `theirs_s` is extrapolated

  /// Returns the ratio of times; a lower bound if `ours` is an upper bound. Requires: ours.
  double times_faster() const { return theirs_s / ours->cost; }
};

/// Compares with textbook shooting at the smallest error of all its meshes. Returns nothing if it did not run.
std::optional<Comparison> with_fixed_mesh(std::span<const RunGroup> groups);

/// Number of points to which path tracing is scaled: about as many as a solution is worth.
inline constexpr double points_of_a_scene = 10'000;
inline constexpr double path_tracing_error = 0.01;  ///< error at which path tracing is compared

/// Compares with path tracing of points_of_a_scene points. Its time is scaled from the `drawn` points that were measured. Returns
/// nothing if it did not run.
std::optional<Comparison> with_path_tracing(std::span<const RunGroup> groups, std::size_t drawn, double error);

/// Sums of wall seconds over the settings that finished both with one and with two threads.
struct ThreadGain {
  double one_s = 0, two_s = 0;
  double times_faster() const { return one_s / two_s; }
};
ThreadGain gain_of_two_threads(std::span<const RunGroup> groups);

/// Returns estimated over true error of the default strategy's runs on one thread that the time limit did not end.
std::vector<double> estimate_ratios(std::span<const MeasuredRun> runs);
/// Returns estimated over true error of the `until_time` runs that did not reach their tolerance.
std::vector<double> estimate_ratios_of_stopped(std::span<const MeasuredRun> runs);

}  // namespace alvor::bench
