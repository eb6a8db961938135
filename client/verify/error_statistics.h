#pragma once
// Statistics of a solution's error against a truth that has noise itself.

#include <cstddef>
#include <span>

namespace alvor {

/// A solution and an estimate of the truth at one point. Means of the bands, W/m2.
struct ComparedPoint {
  double solution = 0;
  double truth = 0;           ///< unbiased
  double truth_variance = 0;  ///< variance of `truth`, estimated without bias
};

/// A value and its 95 % confidence interval.
struct Confidence {
  double value = 0, low = 0, high = 0;
};

/// Errors as if the truth were known exactly: noise of the truth increases a squared difference by its variance on average, so
/// the estimated variance is subtracted. An error that would become negative is 0.
struct ErrorStatistics {
  std::size_t points = 0;
  double mean_truth = 0;  ///< mean irradiance, W/m2
  /// sqrt(mean((H - truth)^2)) / mean(truth). The confidence interval is by the delta method, which linearises the ratio of
  /// means; points are independent. It includes the noise of the truth and the random choice of the points.
  Confidence nrmse;
  /// mean(H) / mean(truth) - 1, with its confidence interval by the delta method.
  Confidence bias;
  /// RMS over points of (H - truth) / truth, without points of zero truth. Noise of the truth enters only in second order.
  double relative_rms = 0;
  double truth_error = 0;           ///< standard error of the truth: RMS over points / mean(truth)
  double relative_truth_error = 0;  ///< RMS over points of standard error / truth
};

/// Returns the statistics. Without points or light all values are 0. If the truth is dark everywhere and the solution is not, the
/// nRMSE is infinite.
ErrorStatistics error_statistics(std::span<const ComparedPoint> points);

}  // namespace alvor
