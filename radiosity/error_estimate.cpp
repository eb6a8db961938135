#include "radiosity/error_estimate.h"

#include <algorithm>
#include <cmath>

namespace alvor {

double interpolation_error(NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                           std::span<const Rgb> value, std::span<const LeafSlope> slope) {
  double worst = 0;
  bool at_crease = neighbours.at_crease();
  const auto miss = [&](NodeIndex from, NodeIndex to) {
    return std::abs((value[to] - value[from] - slope[from].along(centre[to] - centre[from])).mean());
  };
  for (const NodeIndex other : neighbours) {
    if (value[leaf].is_zero() != value[other].is_zero()) at_crease = true;
    else worst = std::max({worst, miss(leaf, other), miss(other, leaf)});
  }
  return worst * (at_crease ? 0.75 : 0.25);
}

double ErrorEstimate::mesh() const { return std::hypot(direct_mesh, indirect_mesh); }
double ErrorEstimate::total() const { return std::hypot(mesh(), sampling, unshot); }

}  // namespace alvor
