#include "bench/error_vs_time/contest/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace alvor::bench {

namespace {

double between(const CurvePoint& before, const CurvePoint& after, double error) {
  if (!(after.error > 0)) return after.cost;
  const double along = std::log(before.error / error) / std::log(before.error / after.error);
  return before.cost * std::pow(after.cost / before.cost, along);
}

}  // namespace

Spread spread_of(std::vector<double> values) {
  assert(!values.empty());
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
  return {median, values.front(), values.back()};
}

std::optional<Reached> cost_to_reach(std::span<const CurvePoint> curve, double error) {
  std::vector<CurvePoint> sorted(curve.begin(), curve.end());
  std::ranges::stable_sort(sorted, {}, &CurvePoint::cost);
  const auto good = std::ranges::find_if(sorted, [&](const CurvePoint& point) { return point.error <= error; });
  if (good == sorted.end()) return std::nullopt;
  if (good == sorted.begin()) return Reached{good->cost, good->error < error};
  return Reached{between(*(good - 1), *good, error)};
}

double sampling_cost_to_reach(const CurvePoint& measured, double error) {
  const double ratio = measured.error / error;
  return measured.cost * ratio * ratio;
}

bool is_within_a_factor_of_two(double ratio) { return ratio >= 0.5 && ratio <= 2; }

}  // namespace alvor::bench
