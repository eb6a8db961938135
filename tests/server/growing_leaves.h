#pragma once

#include "solution/leaf_value.h"

#include <random>
#include <set>
#include <vector>

namespace alvor {

/// Invents leaf values that change and split at random, as a solver might publish them; if `merges`, leaves also become one, as
/// after edits; if `slabs`, some are split into slabs. The same seed gives the same values.
class GrowingLeaves {
 public:
  GrowingLeaves(std::uint32_t roots, unsigned seed, bool merges = false, bool slabs = false);
  /// Returns all roots the first time; later about a quarter of the leaves, some of them split.
  std::vector<LeafValue> next();

 private:
  LeafValue value_of(PatchId leaf);
  void merge(std::vector<LeafValue>& changed);

  std::mt19937 random_;
  std::set<PatchId> leaves_;
  bool merges_, slabs_;
  bool begun_ = false;
};

}  // namespace alvor
