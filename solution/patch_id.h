#pragma once
// The id of a quadtree patch, after the cell ids of google/s2geometry: its bits are the path from the root to the patch, and how
// the patches on it are split.

#include <algorithm>
#include <bit>
#include <cassert>
#include <compare>
#include <cstdint>
#include <functional>

namespace alvor {

/// How a patch is split into its four children: a quad or a triangle into quarters, or a quad into four slabs side by side along
/// u or along v, each as long as the patch and a quarter as wide.
enum class Split : std::uint8_t { quarters, slabs_along_u, slabs_along_v };

/// Returns the split of the other side of a face, whose (u, v) is this side's (v, u).
constexpr Split mirrored(Split how) {
  if (how == Split::quarters) return how;
  return how == Split::slabs_along_u ? Split::slabs_along_v : Split::slabs_along_u;
}

/// A patch id of 64 bits. From the highest: 10 bits that say which of its ancestors were split into slabs, 22 bits of the root
/// patch, a 0 bit, then 2 bits per level, first level first, then a single 1 bit, then zeros. Ids sort in depth-first order of
/// their paths, and a patch's descendants are the contiguous range [range_min, range_max]. Level 0 is the root patch; level
/// `max_level` is the finest.
///
/// On a path there are slabs at two levels at most. The lower 5 of the 10 bits tell of the first of them, the upper 5 of the
/// second: 0 if there is none, else 1 + 2 level + axis, where `level` is that of the patch that was split, and the axis is 0 for
/// slabs along u.
class PatchId {
 public:
  static constexpr int max_level = 15;
  static constexpr std::uint32_t most_roots = 1u << 22;

  constexpr PatchId() = default;  ///< Not a patch: is_valid() is false.

  /// Requires: face < most_roots.
  static constexpr PatchId root(std::uint32_t face) {
    assert(face < most_roots);
    return PatchId((std::uint64_t{face} << 32) | lsb_at(0));
  }
  /// Makes an id from the bits that came over the wire. Check is_valid() before any other use.
  static constexpr PatchId from_bits(std::uint64_t bits) { return PatchId(bits); }
  /// Returns the finest patch whose path is the low 30 bits of `path`, first level in the highest two. It stands for a point of
  /// the face, in whatever way that is split. Requires: face < most_roots.
  static constexpr PatchId finest(std::uint32_t face, std::uint32_t path) {
    return PatchId((std::uint64_t{face} << 32) | (std::uint64_t{path} << 1) | 1u);
  }

  constexpr std::uint64_t bits() const { return bits_; }
  /// Returns the number of 10 bits that says which ancestors were split into slabs; 0 without slabs.
  constexpr int slab_code() const { return static_cast<int>(bits_ >> slab_shift); }
  /// Returns the patch with another such number. Check is_valid() before any other use. Requires: 0 <= code < 1024.
  constexpr PatchId with_slab_code(int code) const {
    return PatchId(place_bits() | static_cast<std::uint64_t>(code) << slab_shift);
  }
  constexpr bool is_valid() const {
    const auto low = static_cast<std::uint32_t>(bits_);
    if (low == 0 || (low >> 31) != 0 || std::countr_zero(low) % 2 != 0) return false;
    return !has_slabs() || has_valid_slabs();
  }

  constexpr std::uint32_t root_face() const { return static_cast<std::uint32_t>(bits_ >> 32) & (most_roots - 1); }
  constexpr int level() const { return max_level - std::countr_zero(static_cast<std::uint32_t>(bits_)) / 2; }
  constexpr bool is_root() const { return (bits_ & (lsb_at(0) * 2 - 1)) == lsb_at(0); }

  constexpr bool has_slabs() const { return slab_code() != 0; }
  /// Returns how its ancestor at `level` - 1 is split. Requires: 1 <= level <= this->level().
  constexpr Split split_above(int level) const {
    for (const int slabs : {first_slabs(), second_slabs()})
      if (level_of(slabs) == level - 1) return split_of(slabs);
    return Split::quarters;
  }
  /// Returns how often its root's u and v were halved to make the patch. Neither is more than `max_level`.
  constexpr int halvings_of_u() const {
    int halvings = level();
    for (const int slabs : {first_slabs(), second_slabs()})
      if (slabs != 0) halvings += split_of(slabs) == Split::slabs_along_u ? 1 : -1;
    return halvings;
  }
  constexpr int halvings_of_v() const { return 2 * level() - halvings_of_u(); }
  /// Returns whether ids can say that the patch is split so.
  constexpr bool may_split(Split how) const {
    if (how == Split::quarters) return std::max(halvings_of_u(), halvings_of_v()) < max_level;
    const int halvings = how == Split::slabs_along_u ? halvings_of_u() : halvings_of_v();
    return second_slabs() == 0 && halvings + 2 <= max_level;
  }

  /// Requires: !is_root().
  constexpr PatchId parent() const {
    assert(!is_root());
    return ancestor(level() - 1);
  }
  /// Requires: level <= this->level().
  constexpr PatchId ancestor(int level) const {
    const std::uint64_t lsb = lsb_at(level);
    return PatchId((bits_ & ~(lsb * 2 - 1) & ~slab_mask) | lsb).with_slab_code(slab_code_at(level));
  }
  /// Requires: may_split(how) and 0 <= k < 4.
  constexpr PatchId child(int k, Split how = Split::quarters) const {
    assert(may_split(how));
    const std::uint64_t lsb = lsb_() >> 2;
    const PatchId same_slabs(bits_ - lsb_() + static_cast<std::uint64_t>(2 * k + 1) * lsb);
    if (how == Split::quarters) return same_slabs;
    const int slabs = 1 + 2 * level() + (how == Split::slabs_along_v);
    return same_slabs.with_slab_code(has_slabs() ? slab_code() | slabs << 5 : slabs);
  }
  /// Returns child `k` of its parent. Requires: !is_root() and 0 <= k < 4.
  constexpr PatchId sibling(int k) const {
    const std::uint64_t lsb = lsb_();
    return PatchId((bits_ & ~(6 * lsb)) | (static_cast<std::uint64_t>(2 * k) * lsb));
  }
  /// Returns the level of the deepest patch whose path begins both paths. Requires: patches of one root, neither contains the
  /// other.
  constexpr int common_level(PatchId other) const {
    const auto difference = static_cast<std::uint32_t>(range_min().bits_ ^ other.range_min().bits_);
    return (std::countl_zero(difference) - 1) / 2;
  }
  /// Returns whether this patch and another say the same of how their common ancestors are split. Requires: neither contains the
  /// other.
  constexpr bool agrees_on_splits(PatchId other) const {
    if (root_face() != other.root_face() || slab_code() == other.slab_code()) return true;
    const int level = common_level(other) + 1;
    return slab_code_at(level) == other.slab_code_at(level);
  }
  /// Returns which child (0 to 3) of its ancestor at `level` - 1 contains this patch. Requires: 1 <= level <= this->level().
  constexpr int child_index(int level) const { return static_cast<int>(bits_ >> (2 * (max_level - level) + 1)) & 3; }

  /// Returns the patch of root `face` that is what this one is of its own root. Requires: face < most_roots.
  constexpr PatchId of_root(std::uint32_t face) const {
    assert(face < most_roots);
    return PatchId((bits_ & ~(std::uint64_t{most_roots - 1} << 32)) | static_cast<std::uint64_t>(face) << 32);
  }
  /// Returns the patch of root `face` in whose place u and v are exchanged: children 1 and 2 of quarters, and the axes of slabs.
  constexpr PatchId mirrored(std::uint32_t face) const {
    const auto lsb = static_cast<std::uint32_t>(lsb_()), path = static_cast<std::uint32_t>(bits_) - lsb;
    std::uint32_t swapped = (path & 0x55555554u) >> 1 | (path & 0x2aaaaaaau) << 1;
    int code = 0;
    for (int shift = 0; shift <= 5; shift += 5) {
      const int slabs = slab_code() >> shift & 31;
      if (slabs == 0) break;
      const auto kept = static_cast<std::uint32_t>(6 * lsb_at(level_of(slabs) + 1));
      swapped = (swapped & ~kept) | (path & kept);
      code |= (((slabs - 1) ^ 1) + 1) << shift;
    }
    return PatchId((std::uint64_t{face} << 32) | swapped | lsb).with_slab_code(code);
  }

  constexpr PatchId range_min() const { return PatchId(place_bits() - (lsb_() - 1)); }
  constexpr PatchId range_max() const { return PatchId(place_bits() + (lsb_() - 1)); }
  /// Returns whether the path of this patch is a prefix of that of `other`. In one forest that means that it contains it.
  constexpr bool contains(PatchId other) const {
    return range_min().bits_ <= other.place_bits() && other.place_bits() <= range_max().bits_;
  }
  /// Returns whether the paths are the same, whatever was split into slabs.
  constexpr bool has_path_of(PatchId other) const { return place_bits() == other.place_bits(); }

  friend constexpr bool operator==(PatchId, PatchId) = default;
  friend constexpr std::strong_ordering operator<=>(PatchId a, PatchId b) {
    if (const auto order = a.place_bits() <=> b.place_bits(); order != 0) return order;
    return a.bits_ <=> b.bits_;
  }

 private:
  static constexpr int slab_shift = 54;
  static constexpr std::uint64_t slab_mask = ~std::uint64_t{0} << slab_shift;

  explicit constexpr PatchId(std::uint64_t bits) : bits_(bits) {}
  static constexpr std::uint64_t lsb_at(int level) { return std::uint64_t{1} << (2 * (max_level - level)); }
  constexpr std::uint64_t lsb_() const { return bits_ & (~bits_ + 1); }
  constexpr std::uint64_t place_bits() const { return bits_ & ~slab_mask; }

  constexpr int first_slabs() const { return slab_code() & 31; }
  constexpr int second_slabs() const { return slab_code() >> 5; }
  static constexpr int level_of(int slabs) { return (slabs + 1) / 2 - 1; }  // -1: none
  static constexpr Split split_of(int slabs) { return (slabs - 1) % 2 == 0 ? Split::slabs_along_u : Split::slabs_along_v; }
  constexpr bool has_valid_slabs() const {
    const int first = level_of(first_slabs()), second = level_of(second_slabs());
    if (first < 0 || std::max(first, second) >= level() || (second >= 0 && second <= first)) return false;
    return std::max(halvings_of_u(), halvings_of_v()) <= max_level;
  }
  constexpr int slab_code_at(int level) const {
    if (level_of(first_slabs()) >= level) return 0;
    return level_of(second_slabs()) >= level ? first_slabs() : slab_code();
  }

  std::uint64_t bits_ = 0;
};

/// Mixes all bits, so that neighbouring ids fall into different hash buckets (finaliser of splitmix64, Steele et al. 2014).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace alvor

template <>
struct std::hash<alvor::PatchId> {
  std::size_t operator()(alvor::PatchId id) const noexcept { return alvor::mix_bits(id.bits()); }
};
