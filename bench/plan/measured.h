#pragma once
// Measures the solve of a scene as planned, and with the planned-off features forced on.

#include "bench/plan/cases.h"
#include "solution/leaf_value.h"

#include <cstdint>
#include <vector>

namespace alvor::bench {

struct PlanRun {
  std::vector<LeafValue> lit_leaves;  ///< in the order of ids
  std::uint64_t rays = 0, leaves = 0;
  double estimated = 0;
  double cpu_s = 0;       ///< the shortest of all runs
  std::size_t bytes = 0;  ///< most bytes in use at a time, by new
};

/// Returns the options of the case; its features are forced on if `forced`.
SolveOptions options_of(const PlanCase& planned, bool forced);

PlanRun measure(const PlanCase& planned, bool forced, int runs);

/// The largest difference of irradiance over the largest irradiance, if the leaves are the same; else the relative difference of
/// the mean irradiance over the area.
struct Difference {
  bool same_leaves = true;
  double value = 0;
};
Difference difference(const PlanCase& planned, const PlanRun& a, const PlanRun& b);

}  // namespace alvor::bench
