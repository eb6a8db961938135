#pragma once
// How far a solution is from a truth that is itself only known with noise.

#include <cstddef>
#include <span>

namespace alvor {

/// A solution and an estimate of the truth at one point. Means of the bands, W/m2.
struct ComparedPoint {
  double solution = 0;
  double truth = 0;           ///< unbiased
  double truth_variance = 0;  ///< of `truth`, estimated without bias
};

/// A value and its 95 % confidence interval.
struct Confidence {
  double value = 0, low = 0, high = 0;
};

/// Errors as they would be if the truth were known exactly: a squared difference is larger by the truth's variance on average, so
/// the estimated variance is subtracted. Where more is subtracted than there was, an error is 0.
struct ErrorStatistics {
  std::size_t points = 0;
  double mean_truth = 0;  ///< mean irradiance, W/m2
  /// sqrt(mean((H - truth)^2)) / mean(truth). The interval is by the delta method: the ratio of means is linearised in the
  /// points, which are independent. It holds the noise of the truth as well as the choice of the points.
  Confidence nrmse;
  /// mean(H) / mean(truth) - 1, likewise.
  Confidence bias;
  /// RMS over points of (H - truth) / truth; points without truth are left out. Second-order in the noise of the truth.
  double relative_rms = 0;
  double truth_error = 0;           ///< standard error of the truth: RMS over points / mean(truth)
  double relative_truth_error = 0;  ///< RMS over points of standard error / truth
};

/// Without points or light all is 0. If all of the truth is dark and the solution is not, the nRMSE is infinite.
ErrorStatistics error_statistics(std::span<const ComparedPoint> points);

}  // namespace alvor
