#include "bench/stability/dense_solve.h"

#include "radiosity/exchange/dense_lu.h"

namespace alvor::bench {

// Solves y = F (e + rho y) for the irradiance y.
std::vector<double> dense_irradiance(const Shooting& system) {
  using Number = long double;
  const auto own = system.unshot_by_leaf();
  const auto patches = system.patches();
  std::vector<std::vector<Number>> matrix(patches.size(), std::vector<Number>(patches.size()));
  std::vector<Number> direct(patches.size());
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    matrix[p][p] += 1;
    for (const std::uint32_t leaf : system.leaves_hit(p)) {
      const std::uint32_t from = system.patch_of(leaf);
      const Number share = Number(1) / patches[p].row->ray_count();
      direct[p] += share * Number(own[leaf].g);
      matrix[p][from] -= share * Number(patches[from].reflectance.g);
    }
  }
  const auto solution = DenseLu(std::move(matrix)).solve(direct);
  return {solution.begin(), solution.end()};
}

}  // namespace alvor::bench
