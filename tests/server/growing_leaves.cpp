#include "tests/server/growing_leaves.h"

namespace alvor {

GrowingLeaves::GrowingLeaves(std::uint32_t roots, unsigned seed) : random_(seed) {
  for (std::uint32_t root = 0; root < roots; ++root) leaves_.insert(PatchId::root(root));
}

LeafValue GrowingLeaves::value_of(PatchId leaf) {
  const auto band = [this] { return static_cast<float>(random_() % 100'000) * 0.37f; };
  return {leaf, {band(), band(), band()}};
}

std::vector<LeafValue> GrowingLeaves::next() {
  std::vector<LeafValue> changed;
  const std::vector<PatchId> before(leaves_.begin(), leaves_.end());
  for (const PatchId leaf : before) {
    const unsigned dice = random_() % 32;
    if (begun_ && dice == 0 && leaf.level() < PatchId::max_level) {
      leaves_.erase(leaf);
      for (int k = 0; k < 4; ++k) {
        leaves_.insert(leaf.child(k));
        changed.push_back(value_of(leaf.child(k)));
      }
    } else if (!begun_ || dice < 8) {
      changed.push_back(value_of(leaf));
    }
  }
  begun_ = true;
  return changed;
}

}  // namespace alvor
