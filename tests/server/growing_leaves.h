#pragma once

#include "solution/leaf_value.h"

#include <random>
#include <set>
#include <vector>

namespace alvor {

/// Invents what a solver might publish: values of leaves that change and split at random, the same for the same seed.
class GrowingLeaves {
 public:
  GrowingLeaves(std::uint32_t roots, unsigned seed);
  /// All roots the first time; later about a quarter of the leaves, some of them split.
  std::vector<LeafValue> next();

 private:
  LeafValue value_of(PatchId leaf);

  std::mt19937 random_;
  std::set<PatchId> leaves_;
  bool begun_ = false;
};

}  // namespace alvor
