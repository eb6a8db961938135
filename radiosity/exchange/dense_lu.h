#pragma once
// Gaussian elimination with partial pivoting, for small systems.

#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace alvor {

/// The LU factors of a square matrix.
template <class Number>
class DenseLu {
 public:
  /// Factors the matrix. Requires: `rows` is square and not singular.
  explicit DenseLu(std::vector<std::vector<Number>> rows) : rows_(std::move(rows)), order_(rows_.size()) {
    for (std::size_t k = 0; k < order_.size(); ++k) order_[k] = k;
    for (std::size_t k = 0; k < order_.size(); ++k) eliminate(k);
  }

  /// Returns x with matrix times x = `right_side`. Requires: one number per row.
  std::vector<Number> solve(const std::vector<Number>& right_side) const {
    assert(right_side.size() == order_.size());
    const std::size_t n = order_.size();
    std::vector<Number> x(n);
    for (std::size_t k = 0; k < n; ++k) {
      x[k] = right_side[order_[k]];
      for (std::size_t j = 0; j < k; ++j) x[k] -= rows_[k][j] * x[j];
    }
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t j = k + 1; j < n; ++j) x[k] -= rows_[k][j] * x[j];
      x[k] /= rows_[k][k];
    }
    return x;
  }

 private:
  void eliminate(std::size_t k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < rows_.size(); ++i)
      if (std::abs(rows_[i][k]) > std::abs(rows_[pivot][k])) pivot = i;
    std::swap(rows_[k], rows_[pivot]);
    std::swap(order_[k], order_[pivot]);
    for (std::size_t i = k + 1; i < rows_.size(); ++i) {
      const Number factor = rows_[i][k] /= rows_[k][k];
      if (factor == 0) continue;
      for (std::size_t j = k + 1; j < rows_.size(); ++j) rows_[i][j] -= factor * rows_[k][j];
    }
  }

  std::vector<std::vector<Number>> rows_;  // the upper triangle and, without its diagonal of ones, the lower one
  std::vector<std::size_t> order_;         // row of the matrix that became each row of the factors
};

}  // namespace alvor
