#pragma once
// Writes docs/error-vs-time.md from the measurements.

#include "bench/error_vs_time/contest/contest.h"

#include <string>

namespace alvor::bench {

struct Measurements {
  std::vector<SceneContest> contests;
  std::vector<Yardstick> yardsticks;  ///< all measurements of it; not empty
  std::uint64_t peak_memory = 0;      ///< see judge_memory(), bytes; 0 if it was not measured

  Spread yardstick_spread_s() const;
  double yardstick_s() const { return yardstick_spread_s().median; }
  /// Returns the speedup that fully parallel work has with two threads.
  Spread two_threads_faster() const;
};

/// Returns the text of the page. `missed`, what missed targets would take, and `tried` are inserted unchanged. The page refers to
/// pictures in the folder error-vs-time beside it.
std::string page(const Measurements& measured, const Settings& settings, const std::string& missed, const std::string& tried);

}  // namespace alvor::bench
