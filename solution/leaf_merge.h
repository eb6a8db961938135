#pragma once
// Merging newer leaf values into a sorted list of leaves.

#include "solution/leaf_value.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace alvor {

inline constexpr std::size_t no_leaf = ~std::size_t{0};

/// Sets `places` to the index in `held` of each patch of `changed`. Returns false if `held` lacks one of them. Requires: both
/// ascend.
inline bool find_places(std::span<const PatchId> held, std::span<const LeafValue> changed, std::vector<std::size_t>& places) {
  places.clear();
  places.reserve(changed.size());
  std::size_t at = 0;
  for (const LeafValue& value : changed) {
    for (std::size_t stride = 1; at < held.size() && held[at] < value.patch; stride *= 2) {
      const std::size_t far = std::min(at + stride, held.size() - 1);
      if (held[far] < value.patch) {
        at = far + 1;
        continue;
      }
      at = static_cast<std::size_t>(std::lower_bound(held.begin() + at, held.begin() + far, value.patch) - held.begin());
      break;
    }
    if (at == held.size() || held[at] != value.patch) return false;
    places.push_back(at++);
  }
  return true;
}

/// Merges `changed` into the leaves `held`. In ascending order of patches, run() calls keep(i) for each held leaf that stays
/// whole, set(holder, j) for changed[j], and inherit(holder, patch) for each sibling that a changed leaf implies. `holder` is the
/// index of the held leaf that was split or replaced, the first of those that became one, or `no_leaf` where no leaf of that root
/// was held. Requires: both lists ascend, no patch overlaps another of its own list, and those of each root in `held` tile it.
template <class Keep, class Set, class Inherit>
class LeafMerge {
 public:
  LeafMerge(std::span<const PatchId> held, std::span<const LeafValue> changed, Keep keep, Set set, Inherit inherit)
      : held_(held), changed_(changed), keep_(keep), set_(set), inherit_(inherit) {}

  void run() {
    std::size_t i = 0;
    for (std::size_t j = 0; j < changed_.size();) {
      const PatchId first = changed_[j].patch;
      for (; i < held_.size() && held_[i].range_max() < first.range_min(); ++i) keep_(i);
      const bool is_held = i < held_.size() && held_[i].contains(first);
      if (!is_held && i < held_.size() && first.contains(held_[i])) {
        set_(i, j++);
        while (i < held_.size() && held_[i] <= first.range_max()) ++i;
        continue;
      }
      const PatchId whole = is_held ? held_[i] : PatchId::root(first.root_face());
      const std::size_t end = end_within(whole, j, changed_.size());
      fill(whole, is_held ? i : no_leaf, j, end);
      i += is_held;
      j = end;
    }
    for (; i < held_.size(); ++i) keep_(i);
  }

 private:
  std::size_t end_within(PatchId patch, std::size_t j, std::size_t end) const {
    while (j < end && changed_[j].patch <= patch.range_max()) ++j;
    return j;
  }
  void fill(PatchId patch, std::size_t holder, std::size_t j, std::size_t end) {
    if (j == end) return inherit_(holder, patch);
    if (changed_[j].patch == patch) return set_(holder, j);
    for (int k = 0; k < 4; ++k) {
      const std::size_t next = end_within(patch.child(k), j, end);
      fill(patch.child(k), holder, j, next);
      j = next;
    }
  }

  std::span<const PatchId> held_;
  std::span<const LeafValue> changed_;
  Keep keep_;
  Set set_;
  Inherit inherit_;
};

}  // namespace alvor
