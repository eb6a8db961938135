#pragma once
// Fits a polynomial in two coordinates to samples of irradiance by weighted least squares.

#include "solution/relative_light.h"

#include <algorithm>
#include <array>
#include <optional>
#include <span>

namespace alvor {

/// A sample of irradiance: place (s, t) relative to a row's centre in edges of the row's patch, number of rays, value per band in
/// emission units.
struct WindowSample {
  double s, t, rays, r, g, b;
};

/// Samples around a row, four side by side, so that sums over them are made four at a time.
class SampleBlocks {
 public:
  static constexpr std::size_t most = 192;  ///< samples; more are ignored: two for each of 64 rows, and 64 more
  using Lanes [[gnu::vector_size(4 * sizeof(double))]] = double;
  struct Block {
    Lanes s, t, rays, r, g, b;
  };

  void add(const WindowSample& sample) {
    if (count_ == most) return;
    const std::size_t lane = count_ % lanes;
    Block& block = blocks_[count_ / lanes];
    if (lane == 0) block = no_samples();
    block.s[lane] = sample.s, block.t[lane] = sample.t, block.rays[lane] = sample.rays;
    block.r[lane] = sample.r, block.g[lane] = sample.g, block.b[lane] = sample.b;
    ++count_;
  }
  std::span<const Block> blocks() const { return std::span(blocks_).first((count_ + lanes - 1) / lanes); }

 private:
  static constexpr std::size_t lanes = 4;
  /// A lane without a sample is outside every radius.
  static Block no_samples() {
    constexpr Lanes far_away{1e9, 1e9, 1e9, 1e9}, none{};
    return {far_away, far_away, none + 1, none, none, none};
  }
  std::array<Block, most / lanes> blocks_;
  std::size_t count_ = 0;
};

/// The normal equations of a weighted fit of the first `n` functions of 1, s, t, s^2, s t, t^2 to the samples within a radius.
/// Their weights are (1 - (s^2 + t^2) / radius^2)^2 times their rays. Products of two functions are monomials of twice the
/// degree, so one sum per monomial is enough.
template <int n>
class FieldEquations {
 public:
  FieldEquations(const SampleBlocks& samples, double radius) {
    const double inverse = 1 / (radius * radius);
    Sums sums{};
    for (const SampleBlocks::Block& block : samples.blocks()) add(block, inverse, sums);
    for (int m = 0; m < moments; ++m) moment_[m] = sum(sums.moment[m]);
    for (int i = 0; i < n; ++i)
      for (int b = 0; b < 3; ++b) band_[i][b] = sum(sums.band[i][b]);
    squares_ = sum(sums.squares);
    weight_over_rays_ = sum(sums.weight_over_rays);
    count_ = sum(sums.count);
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
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) a[i][j] = moment_[moment_of_product(i, j)];
      for (int b = 0; b < 3; ++b) a[i][bands + b] = band_[i][b];
      a[i][response] = i == 0;
    }
    for (int i = 0; i < n; ++i)
      if (!eliminate(a, i)) return std::nullopt;
    Solution solution;
    double explained = 0;
    for (int i = 0; i < n; ++i) {
      solution.coefficient[i] = {a[i][bands], a[i][bands + 1], a[i][bands + 2]};
      explained += solution.coefficient[i].mean() * (band_[i][0] + band_[i][1] + band_[i][2]) / 3;
    }
    const double freedom = 1 - double(n) / count_;
    solution.misfit = std::max(0.0, squares_ - explained) / moment_[0] / freedom;
    solution.response = kernel_response * a[0][response];
    solution.noise = weight_over_rays_ / moment_[0];
    return solution;
  }

 private:
  using Lanes = SampleBlocks::Lanes;
  // Ratio of the mean of w^2 to the mean of w near the fit's centre, w = (1 - r^2)^2 being the weights. The exact ratio on a disk
  // evenly filled with samples is 0.60 for a plane and 0.74 for a quadratic.
  static constexpr double kernel_response = 0.7;
  static constexpr int degree = n == 6 ? 4 : 2, moments = (degree + 1) * (degree + 2) / 2;
  static constexpr int bands = n, response = n + 3, width = n + 4;
  static_assert(n == 3 || n == 6, "all functions of a degree");

  struct Sums {
    Lanes moment[moments], band[n][3], squares, weight_over_rays, count;
  };
  /// Monomials are numbered 1, s, t, s^2, s t, t^2, s^3, ..., as the functions are.
  static constexpr int moment_of_product(int i, int j) {
    constexpr int of_s[6] = {0, 1, 0, 2, 1, 0}, of_t[6] = {0, 0, 1, 0, 1, 2};
    const int t = of_t[i] + of_t[j], all = of_s[i] + of_s[j] + t;
    return all * (all + 1) / 2 + t;
  }
  static void add(const SampleBlocks::Block& sample, double inverse_squared_radius, Sums& sums) {
    const Lanes q = 1 - (sample.s * sample.s + sample.t * sample.t) * inverse_squared_radius;
    const Lanes weight = q > 0 ? q * q * sample.rays : Lanes{};
    Lanes monomial[moments];
    monomial[0] = weight;
    for (int d = 1, m = 1; d <= degree; ++d) {
      for (int k = 0; k < d; ++k, ++m) monomial[m] = monomial[m - d] * sample.s;
      monomial[m] = monomial[m - d - 1] * sample.t;
      ++m;
    }
    for (int m = 0; m < moments; ++m) sums.moment[m] += monomial[m];
    for (int i = 0; i < n; ++i) {
      sums.band[i][0] += monomial[i] * sample.r;
      sums.band[i][1] += monomial[i] * sample.g;
      sums.band[i][2] += monomial[i] * sample.b;
    }
    const Lanes mean = (sample.r + sample.g + sample.b) / 3;
    sums.squares += weight * mean * mean;
    sums.weight_over_rays += weight / sample.rays;
    sums.count += q > 0 ? Lanes{1, 1, 1, 1} : Lanes{};
  }
  static double sum(const Lanes& lanes) { return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]); }

  /// Eliminates column i (Gauss-Jordan). Returns false if its pivot is lost in rounding. The matrix is symmetric positive
  /// definite, so pivots are taken in order.
  bool eliminate(double (&a)[n][width], int i) const {
    if (!(a[i][i] > 1e-9 * moment_[moment_of_product(i, i)])) return false;
    const double inverse = 1 / a[i][i];
    for (int j = i; j < width; ++j) a[i][j] *= inverse;
    for (int k = 0; k < n; ++k) {
      if (k == i) continue;
      const double factor = a[k][i];
      for (int j = i; j < width; ++j) a[k][j] -= factor * a[i][j];
    }
    return true;
  }

  double moment_[moments], band_[n][3];
  double squares_ = 0, weight_over_rays_ = 0, count_ = 0;
};

}  // namespace alvor
