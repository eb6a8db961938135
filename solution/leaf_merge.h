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
/// whole, set(holder, j) for changed[j], and inherit(holder, patch, is_of_many) for each sibling that a changed leaf implies.
/// `holder` is the index of the held leaf that was split or replaced, the first of those that became one, or `no_leaf` where no
/// leaf of that root was held. Where the changed leaves say that a patch is split in another way than the held ones say, as after
/// a solve has begun anew, all held leaves in it become one before it is split; then `is_of_many` is true. Requires: both lists
/// ascend, no patch overlaps another of its own list, the patches of each list agree on how their ancestors are split, and those
/// of each root in `held` tile it.
template <class Keep, class Set, class Inherit>
class LeafMerge {
 public:
  LeafMerge(std::span<const PatchId> held, std::span<const LeafValue> changed, Keep keep, Set set, Inherit inherit)
      : held_(held), changed_(changed), keep_(keep), set_(set), inherit_(inherit) {}

  void run() {
    std::size_t i = 0;
    for (std::size_t j = 0; j < changed_.size();) {
      const PatchId first = changed_[j].patch;
      const PatchId whole = to_be_split(first, i);
      for (; i < held_.size() && held_[i].range_max() < whole.range_min(); ++i) keep_(i);
      const std::size_t holder = i < held_.size() && whole.contains(held_[i]) ? i : no_leaf;
      const std::size_t held_before = i;
      while (i < held_.size() && whole.contains(held_[i])) ++i;
      const std::size_t end = end_within(whole, j, changed_.size());
      fill(whole, holder, i - held_before > 1, j, end);
      j = end;
    }
    for (; i < held_.size(); ++i) keep_(i);
  }

 private:
  /// Returns the patch in which held leaves give way to changed ones: the changed leaf itself, the held leaf that contains it,
  /// the outermost patch that both lists split but in different ways, or the whole root where nothing is held. `from` is an index
  /// below which no held leaf overlaps it.
  PatchId to_be_split(PatchId changed, std::size_t from) const {
    const auto found = std::lower_bound(held_.begin() + static_cast<std::ptrdiff_t>(from), held_.end(), changed.range_min(),
                                        [](PatchId held, PatchId first) { return held.range_max() < first; });
    if (found == held_.end() || found->root_face() != changed.root_face()) return PatchId::root(changed.root_face());
    const int common = std::min(found->level(), changed.level());
    if (found->slab_code() == changed.slab_code()) return changed.ancestor(common);
    for (int level = 1; level <= common; ++level)
      if (found->split_above(level) != changed.split_above(level)) return changed.ancestor(level - 1);
    return changed.ancestor(common);
  }
  std::size_t end_within(PatchId patch, std::size_t j, std::size_t end) const {
    while (j < end && patch.contains(changed_[j].patch)) ++j;
    return j;
  }
  void fill(PatchId patch, std::size_t holder, bool is_of_many, std::size_t j, std::size_t end) {
    if (j == end) return inherit_(holder, patch, is_of_many);
    if (changed_[j].patch.has_path_of(patch)) return set_(holder, j);
    const PatchId below = changed_[j].patch.ancestor(patch.level() + 1);
    for (int k = 0; k < 4; ++k) {
      const PatchId child = below.sibling(k);
      const std::size_t next = end_within(child, j, end);
      fill(child, holder, is_of_many, j, next);
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
