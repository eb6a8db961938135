#pragma once
// docs/error-vs-time.md, written from what was measured.

#include "bench/error_vs_time/contest.h"

#include <string>

namespace alvor::bench {

struct Measurements {
  std::vector<SceneContest> contests;
  std::vector<Yardstick> yardsticks;  ///< each time that it was taken; not empty

  Spread yardstick_spread_s() const;
  double yardstick_s() const { return yardstick_spread_s().median; }
  /// What work that is all parallel gains.
  Spread two_threads_faster() const;
};

/// `tried` is taken as it is. Pictures are expected in the folder error-vs-time beside the page.
std::string page(const Measurements& measured, const Settings& settings, const std::string& tried);

}  // namespace alvor::bench
