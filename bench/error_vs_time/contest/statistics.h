#pragma once
// Summaries of a few repetitions, and curves of error against cost.

#include <optional>
#include <span>
#include <vector>

namespace alvor::bench {

/// The median, smallest and largest of some repetitions.
struct Spread {
  double median = 0, low = 0, high = 0;
};

/// Returns the spread of the values. The median of an even number of values is the mean of the middle two. Requires:
/// !values.empty(), no NaN.
Spread spread_of(std::vector<double> values);

/// The cost (seconds or rays) and the error of one setting.
struct CurvePoint {
  double cost = 0, error = 0;
};

struct Reached {
  double cost = 0;
  bool at_most = false;  ///< even the cheapest setting has a smaller error; a cheaper one might do
};

/// Returns the cost of the first error at or below `error`, with settings sorted by cost; interpolates linearly in log-log
/// between two settings. Returns nothing if no setting is that good. Requires: error > 0, costs > 0.
std::optional<Reached> cost_to_reach(std::span<const CurvePoint> curve, double error);

/// Returns the cost at which a sampler reaches `error`, if its error falls as one over the square root of its cost. Requires:
/// error > 0.
double sampling_cost_to_reach(const CurvePoint& measured, double error);

/// Returns whether `ratio`, of estimate to truth, lies between 1/2 and 2.
bool is_within_a_factor_of_two(double ratio);

}  // namespace alvor::bench
