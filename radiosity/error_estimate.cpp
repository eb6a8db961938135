#include "radiosity/error_estimate.h"

#include <algorithm>
#include <cmath>

namespace alvor {

std::vector<double> interpolation_errors(const PatchForest& forest, std::span<const NodeIndex> leaves, std::span<const Vec3> centre,
                                         std::span<const Rgb> value, std::span<const LeafSlope> slopes) {
  std::vector<double> worst(forest.node_count());
  std::vector<bool> at_crease(forest.node_count());
  std::vector<NodeIndex> neighbours;
  for (std::size_t n = 0; n < leaves.size(); ++n) {
    const NodeIndex leaf = leaves[n];
    at_crease[leaf] = smooth_neighbours(forest, leaf, neighbours);
    for (const NodeIndex other : neighbours) {
      if (value[leaf].is_zero() != value[other].is_zero()) {
        at_crease[leaf] = true;
        continue;
      }
      const Rgb predicted = value[leaf] + slopes[n].along(centre[other] - centre[leaf]);
      const double difference = std::abs((value[other] - predicted).mean());
      worst[leaf] = std::max(worst[leaf], difference);
      worst[other] = std::max(worst[other], difference);
    }
  }
  std::vector<double> errors;
  errors.reserve(leaves.size());
  for (const NodeIndex leaf : leaves) errors.push_back(worst[leaf] * (at_crease[leaf] ? 0.75 : 0.25));
  return errors;
}

double ErrorEstimate::mesh() const { return std::hypot(direct_mesh, indirect_mesh); }
double ErrorEstimate::total() const { return std::hypot(mesh(), sampling, unshot); }

}  // namespace alvor
