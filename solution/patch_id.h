#pragma once
// The id of a quadtree patch, after the cell ids of google/s2geometry: the bits of the id are the path from the root to the
// patch.

#include <bit>
#include <cassert>
#include <compare>
#include <cstdint>
#include <functional>

namespace alvor {

/// A patch id of 64 bits: the root patch in the upper 32 bits, then 2 bits per level, first level first, then a single 1 bit,
/// then zeros. Ids sort in depth-first order, and a patch's descendants are the contiguous range [range_min, range_max]. Level 0
/// is the root patch; level `max_level` is the finest.
class PatchId {
 public:
  static constexpr int max_level = 15;

  constexpr PatchId() = default;  ///< Not a patch: is_valid() is false.

  static constexpr PatchId root(std::uint32_t face) { return PatchId((std::uint64_t{face} << 32) | lsb_at(0)); }
  /// Makes an id from the bits that came over the wire. Check is_valid() before any other use.
  static constexpr PatchId from_bits(std::uint64_t bits) { return PatchId(bits); }
  /// Returns the finest patch whose path is the low 30 bits of `path`, first level in the highest two.
  static constexpr PatchId finest(std::uint32_t face, std::uint32_t path) {
    return PatchId((std::uint64_t{face} << 32) | (std::uint64_t{path} << 1) | 1u);
  }

  constexpr std::uint64_t bits() const { return bits_; }
  constexpr bool is_valid() const {
    const auto low = static_cast<std::uint32_t>(bits_);
    return low != 0 && (low >> 31) == 0 && std::countr_zero(low) % 2 == 0;
  }

  constexpr std::uint32_t root_face() const { return static_cast<std::uint32_t>(bits_ >> 32); }
  constexpr int level() const { return max_level - std::countr_zero(static_cast<std::uint32_t>(bits_)) / 2; }
  constexpr bool is_root() const { return (bits_ & (lsb_at(0) * 2 - 1)) == lsb_at(0); }

  /// Requires: !is_root().
  constexpr PatchId parent() const {
    assert(!is_root());
    const std::uint64_t lsb = lsb_() << 2;
    return PatchId((bits_ & ~(lsb * 2 - 1)) | lsb);
  }
  /// Requires: level <= this->level().
  constexpr PatchId ancestor(int level) const {
    const std::uint64_t lsb = lsb_at(level);
    return PatchId((bits_ & ~(lsb * 2 - 1)) | lsb);
  }
  /// Requires: level() < max_level and 0 <= k < 4.
  constexpr PatchId child(int k) const {
    assert(level() < max_level);
    const std::uint64_t lsb = lsb_() >> 2;
    return PatchId(bits_ - lsb_() + static_cast<std::uint64_t>(2 * k + 1) * lsb);
  }
  /// Returns which child (0 to 3) of its ancestor at `level` - 1 contains this patch. Requires: 1 <= level <= this->level().
  constexpr int child_index(int level) const { return static_cast<int>(bits_ >> (2 * (max_level - level) + 1)) & 3; }

  /// Returns the patch of root `face` with children 1 and 2 exchanged at each level: u and v are exchanged.
  constexpr PatchId mirrored(std::uint32_t face) const {
    const auto lsb = static_cast<std::uint32_t>(lsb_()), path = static_cast<std::uint32_t>(bits_) - lsb;
    const std::uint32_t swapped = (path & 0x55555554u) >> 1 | (path & 0x2aaaaaaau) << 1;
    return PatchId((std::uint64_t{face} << 32) | swapped | lsb);
  }

  constexpr PatchId range_min() const { return PatchId(bits_ - (lsb_() - 1)); }
  constexpr PatchId range_max() const { return PatchId(bits_ + (lsb_() - 1)); }
  constexpr bool contains(PatchId other) const { return range_min() <= other && other <= range_max(); }

  friend constexpr auto operator<=>(PatchId, PatchId) = default;

 private:
  explicit constexpr PatchId(std::uint64_t bits) : bits_(bits) {}
  static constexpr std::uint64_t lsb_at(int level) { return std::uint64_t{1} << (2 * (max_level - level)); }
  constexpr std::uint64_t lsb_() const { return bits_ & (~bits_ + 1); }

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
