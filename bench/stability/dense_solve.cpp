#include "bench/stability/dense_solve.h"

#include <algorithm>
#include <cmath>

namespace alvor::bench {

namespace {

using Number = long double;

class LinearSystem {
 public:
  explicit LinearSystem(std::size_t n) : rows_(n, std::vector<Number>(n + 1)) {}
  Number& operator()(std::size_t row, std::size_t column) { return rows_[row][column]; }
  Number& right_side(std::size_t row) { return rows_[row].back(); }

  std::vector<double> solved() {
    const std::size_t n = rows_.size();
    for (std::size_t k = 0; k < n; ++k) eliminate(k);
    std::vector<double> x(n);
    for (std::size_t k = n; k-- > 0;) {
      Number sum = rows_[k][n];
      for (std::size_t j = k + 1; j < n; ++j) sum -= rows_[k][j] * rows_[j][n];
      rows_[k][n] = sum / rows_[k][k];
      x[k] = static_cast<double>(rows_[k][n]);
    }
    return x;
  }

 private:
  void eliminate(std::size_t k) {
    const std::size_t n = rows_.size();
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < n; ++i)
      if (std::abs(rows_[i][k]) > std::abs(rows_[pivot][k])) pivot = i;
    std::swap(rows_[k], rows_[pivot]);
    for (std::size_t i = k + 1; i < n; ++i) {
      const Number factor = rows_[i][k] / rows_[k][k];
      if (factor == 0) continue;
      for (std::size_t j = k; j <= n; ++j) rows_[i][j] -= factor * rows_[k][j];
    }
  }

  std::vector<std::vector<Number>> rows_;  // each ends with its right side
};

}  // namespace

// Of y = F (e + rho y).
std::vector<double> dense_irradiance(const Shooting& system) {
  const auto own = system.unshot_by_leaf();
  const auto patches = system.patches();
  LinearSystem equations(patches.size());
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    equations(p, p) += 1;
    for (const std::uint32_t leaf : system.leaves_hit(p)) {
      const std::uint32_t from = system.patch_of(leaf);
      const Number weight = Number(1) / patches[p].row->ray_count();
      // What leaves it at first is e, and rho times what its own row brings, which is its unshot part.
      equations.right_side(p) += weight * Number(own[leaf].g);
      equations(p, from) -= weight * Number(patches[from].reflectance.g);
    }
  }
  return equations.solved();
}

}  // namespace alvor::bench
