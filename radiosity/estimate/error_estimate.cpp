#include "radiosity/estimate/error_estimate.h"

#include <algorithm>
#include <cmath>

namespace alvor {

double interpolation_error(NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                           std::span<const RelativeLight> value, std::span<const Vec3> slope) {
  double squares = 0, count = 0;
  bool at_crease = neighbours.at_crease();
  const auto miss = [&](NodeIndex from, NodeIndex to) {
    return (value[to] - value[from]).mean() - dot(slope[from], centre[to] - centre[from]);
  };
  for (const NodeIndex other : neighbours) {
    if (value[leaf].is_zero() != value[other].is_zero()) {
      at_crease = true;
      continue;
    }
    const double there = miss(leaf, other), back = miss(other, leaf);
    squares += std::max(there * there, back * back);
    count += 1;
  }
  return count > 0 ? std::sqrt(squares / count) * (at_crease ? 0.4 : 0.25) : 0;
}

double ErrorEstimate::mesh() const { return std::hypot(interpolation, misfit); }
double ErrorEstimate::total() const { return std::hypot(std::hypot(mesh(), sampling), std::hypot(unshot, balance)); }

}  // namespace alvor
