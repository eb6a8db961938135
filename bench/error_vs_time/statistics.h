#pragma once
// Few repetitions summed up, and curves of error against cost.

#include <optional>
#include <span>
#include <vector>

namespace alvor::bench {

/// The middle one of some repetitions, and the ends.
struct Spread {
  double median = 0, low = 0, high = 0;
};

/// The median of an even number is the mean of the middle two. Requires: !values.empty(), no NaN.
Spread spread_of(std::vector<double> values);

/// What a setting costs (seconds, rays) and how wrong it is.
struct CurvePoint {
  double cost = 0, error = 0;
};

struct Reached {
  double cost = 0;
  bool at_most = false;  ///< the cheapest setting is better already: a cheaper one might have done
};

/// What the first error at or below `error` costs, settings taken in the order of their cost: between two of them on a straight
/// line in log-log. Nothing where none is that good. Requires: error > 0, costs > 0.
std::optional<Reached> cost_to_reach(std::span<const CurvePoint> curve, double error);

/// What a sampler whose error falls as one over the square root of its cost needs for `error`. Requires: error > 0.
double sampling_cost_to_reach(const CurvePoint& measured, double error);

/// Whether estimate and truth differ by no more than a factor of two.
bool is_within_a_factor_of_two(double ratio);

}  // namespace alvor::bench
