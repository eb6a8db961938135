#pragma once
// One scene solved as planned, and with the features that its plan switches off.

#include "bench/plan/cases.h"
#include "solution/leaf_value.h"

#include <cstdint>
#include <vector>

namespace alvor::bench {

struct PlanRun {
  std::vector<LeafValue> lit_leaves;  ///< in the order of ids
  std::uint64_t rays = 0, leaves = 0;
  double estimated = 0;
  double cpu_s = 0;       ///< the shortest of some runs
  std::size_t bytes = 0;  ///< most in use at a time, by new
};

/// The options of the case, with its features on if `forced`.
SolveOptions options_of(const PlanCase& planned, bool forced);

PlanRun measure(const PlanCase& planned, bool forced, int runs);

/// Largest difference of irradiance over the largest irradiance, if the leaves are the same; else of the mean irradiance over
/// the area, over its value.
struct Difference {
  bool same_leaves = true;
  double value = 0;
};
Difference difference(const PlanCase& planned, const PlanRun& a, const PlanRun& b);

}  // namespace alvor::bench
