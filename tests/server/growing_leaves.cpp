#include "tests/server/growing_leaves.h"

#include <algorithm>
#include <iterator>

namespace alvor {

GrowingLeaves::GrowingLeaves(std::uint32_t roots, unsigned seed, bool merges, bool slabs)
    : random_(seed), merges_(merges), slabs_(slabs) {
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
    if (begun_ && dice == 0 && leaf.may_split(Split::quarters)) {
      Split how = slabs_ ? static_cast<Split>(random_() % 3) : Split::quarters;
      if (!leaf.may_split(how)) how = Split::quarters;
      leaves_.erase(leaf);
      for (int k = 0; k < 4; ++k) {
        leaves_.insert(leaf.child(k, how));
        changed.push_back(value_of(leaf.child(k, how)));
      }
    } else if (!begun_ || dice < 8) {
      changed.push_back(value_of(leaf));
    }
  }
  if (merges_ && begun_ && random_() % 2 == 0) merge(changed);
  begun_ = true;
  return changed;
}

/// Makes one leaf of all within a patch some levels above one of them.
void GrowingLeaves::merge(std::vector<LeafValue>& changed) {
  const PatchId leaf = *std::next(leaves_.begin(), static_cast<std::ptrdiff_t>(random_() % leaves_.size()));
  const PatchId whole = leaf.ancestor(std::max(0, leaf.level() - 1 - static_cast<int>(random_() % 3)));
  const auto is_within = [&](const auto& of) { return whole.contains(of); };
  std::erase_if(leaves_, is_within);
  std::erase_if(changed, [&](const LeafValue& value) { return is_within(value.patch); });
  leaves_.insert(whole);
  changed.insert(std::ranges::upper_bound(changed, whole, {}, &LeafValue::patch), value_of(whole));
}

}  // namespace alvor
