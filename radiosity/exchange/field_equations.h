#pragma once
// Fits a polynomial in two coordinates to samples of irradiance by weighted least squares.

#include "solution/relative_light.h"

#include <algorithm>
#include <array>
#include <optional>

namespace alvor {

/// A sample of irradiance: place (s, t) relative to a row's centre in edges of the row's patch, number of rays, value per band in
/// emission units.
struct WindowSample {
  double s, t, rays, r, g, b;
};

/// The normal equations of a weighted fit of the first `n` functions of 1, s, t, s^2, s t, t^2. Row i of `sums_` holds the
/// products of function i with all six functions, then with the three bands.
template <int n>
class FieldEquations {
 public:
  void add(const WindowSample& sample, double weight) {
    const double s = sample.s, t = sample.t;
    const double row[width] = {1, s, t, s * s, s * t, t * t, sample.r, sample.g, sample.b, 0, 0, 0};
    for (int i = 0; i < n; ++i) {
      const double scale = weight * row[i];
      for (int j = 0; j < width; ++j) sums_[i][j] += scale * row[j];
    }
    const double mean = (sample.r + sample.g + sample.b) / 3;
    squares_ += weight * mean * mean;
    weight_over_rays_ += weight / sample.rays;
    ++count_;
  }

  struct Solution {
    std::array<RelativeLight, 6> coefficient{};
    double misfit = 0;    ///< mean square residual of the samples, mean over bands
    double response = 0;  ///< variance of the fit's value at the centre, as a multiple of one ray's variance
    double noise = 0;     ///< mean variance of a sample, as a multiple of one ray's variance
  };
  /// Returns the fit; nothing if there are fewer than n + n / 2 samples or they do not determine it.
  std::optional<Solution> solve() const {
    if (count_ < n + n / 2) return std::nullopt;
    double a[n][width];
    for (int i = 0; i < n; ++i) std::copy_n(sums_[i], width, a[i]);
    for (int i = 0; i < n; ++i) a[i][response] = i == 0;
    for (int i = 0; i < n; ++i)
      if (!eliminate(a, i)) return std::nullopt;
    Solution solution;
    double explained = 0;
    for (int i = 0; i < n; ++i) {
      solution.coefficient[i] = {a[i][bands], a[i][bands + 1], a[i][bands + 2]};
      explained += solution.coefficient[i].mean() * (sums_[i][bands] + sums_[i][bands + 1] + sums_[i][bands + 2]) / 3;
    }
    const double freedom = 1 - double(n) / count_;
    solution.misfit = std::max(0.0, squares_ - explained) / sums_[0][0] / freedom;
    solution.response = kernel_response * a[0][response];
    solution.noise = weight_over_rays_ / sums_[0][0];
    return solution;
  }

 private:
  // Ratio of the mean of w^2 to the mean of w near the fit's centre, w = (1 - r^2)^2 being the weights. The exact ratio on a disk
  // evenly filled with samples is 0.60 for a plane and 0.74 for a quadratic.
  static constexpr double kernel_response = 0.7;
  static constexpr int bands = 6, response = 9, width = 12;
  /// Eliminates column i (Gauss-Jordan). Returns false if its pivot is lost in rounding. The matrix is symmetric positive
  /// definite, so pivots are taken in order.
  bool eliminate(double (&a)[n][width], int i) const {
    if (!(a[i][i] > 1e-9 * sums_[i][i])) return false;
    const double inverse = 1 / a[i][i];
    for (int j = 0; j < width; ++j) a[i][j] *= inverse;
    for (int k = 0; k < n; ++k) {
      if (k == i) continue;
      const double factor = a[k][i];
      for (int j = 0; j < width; ++j) a[k][j] -= factor * a[i][j];
    }
    return true;
  }

  double sums_[n][width] = {};
  double squares_ = 0, weight_over_rays_ = 0;
  int count_ = 0;
};

}  // namespace alvor
