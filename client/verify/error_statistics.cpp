#include "client/verify/error_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alvor {

namespace {

constexpr double normal_97_5 = 1.959964;  ///< 97.5 % quantile of the normal distribution, for two-sided 95 % intervals

constexpr double infinite = std::numeric_limits<double>::infinity();

template <class Value>
double mean_of(std::span<const ComparedPoint> points, Value value) {
  double sum = 0;
  for (const ComparedPoint& point : points) sum += value(point);
  return sum / static_cast<double>(points.size());
}

double error(const ComparedPoint& p) { return p.solution - p.truth; }
double squared_error(const ComparedPoint& p) { return error(p) * error(p) - p.truth_variance; }
double truth(const ComparedPoint& p) { return p.truth; }

/// Returns the root, or 0 for negative values. NaN stays NaN: a solution with such values is not a good one.
double positive_root(double square) { return square < 0 ? 0 : std::sqrt(square); }

/// Returns the standard error of a mean over points. `influence` is each point's deviation, with mean 0.
template <class Influence>
double standard_error(std::span<const ComparedPoint> points, Influence influence) {
  const double square = mean_of(points, [&](const ComparedPoint& p) { return influence(p) * influence(p); });
  return std::sqrt(square / static_cast<double>(std::max<std::size_t>(1, points.size() - 1)));
}

Confidence nrmse_of(std::span<const ComparedPoint> points, double mean_truth) {
  const double mean_square = mean_of(points, squared_error), scale = 1 / (mean_truth * mean_truth);
  const double spread = normal_97_5 * standard_error(points, [&](const ComparedPoint& p) {
                          return scale * (squared_error(p) - mean_square - 2 * mean_square * (p.truth / mean_truth - 1));
                        });
  const double square = scale * mean_square;
  // The estimate of the squared error is negative where the noise of the truth exceeds it. A squared error never is, so the upper
  // end of its interval lies at least one spread above 0.
  return {positive_root(square), positive_root(square - spread), positive_root(std::max(square, 0.0) + spread)};
}

Confidence bias_of(std::span<const ComparedPoint> points, double mean_truth) {
  const double bias = mean_of(points, error) / mean_truth;
  const double spread =
      normal_97_5 * standard_error(points, [&](const ComparedPoint& p) { return (error(p) - bias * p.truth) / mean_truth; });
  return {bias, bias - spread, bias + spread};
}

/// Returns the root of the mean of `square` / truth^2 over the points whose truth is positive.
template <class Square>
double relative_root(std::span<const ComparedPoint> points, Square square) {
  double sum = 0, count = 0;
  for (const ComparedPoint& p : points)
    if (p.truth > 0) sum += square(p) / (p.truth * p.truth), ++count;
  return count > 0 ? positive_root(sum / count) : 0;
}

}  // namespace

ErrorStatistics error_statistics(std::span<const ComparedPoint> points) {
  ErrorStatistics statistics;
  statistics.points = points.size();
  if (points.empty()) return statistics;
  const auto variance = [](const ComparedPoint& p) { return p.truth_variance; };
  statistics.mean_truth = mean_of(points, truth);
  statistics.relative_rms = relative_root(points, squared_error);
  statistics.relative_truth_error = relative_root(points, variance);
  if (!(statistics.mean_truth > 0)) {
    const bool lit = std::ranges::any_of(points, [](const ComparedPoint& p) { return p.solution != 0; });
    if (lit) statistics.nrmse = {infinite, infinite, infinite};
    return statistics;
  }
  statistics.nrmse = nrmse_of(points, statistics.mean_truth);
  statistics.bias = bias_of(points, statistics.mean_truth);
  statistics.truth_error = std::sqrt(mean_of(points, variance)) / statistics.mean_truth;
  return statistics;
}

}  // namespace alvor
