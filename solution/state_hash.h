#pragma once
// A hash of a set of leaves that does not depend on their order and is updated leaf by leaf.

#include "solution/leaf_value.h"

#include <bit>
#include <cstdint>

namespace alvor {

/// Two sums modulo 2^32 of hashes of the leaves: one in the upper half, one in the lower. It needs only 32-bit arithmetic, which
/// browsers have.
class StateHash {
 public:
  constexpr void add(const LeafValue& leaf) {
    const auto [a, b] = halves(leaf);
    upper_ += a, lower_ += b;
  }
  constexpr void remove(const LeafValue& leaf) {
    const auto [a, b] = halves(leaf);
    upper_ -= a, lower_ -= b;
  }
  constexpr std::uint64_t bits() const { return std::uint64_t{upper_} << 32 | lower_; }

 private:
  struct Halves {
    std::uint32_t a, b;
  };
  static constexpr Halves halves(const LeafValue& leaf) {
    const std::uint64_t id = leaf.patch.bits();
    const std::uint32_t words[] = {
        static_cast<std::uint32_t>(id >> 32), static_cast<std::uint32_t>(id), std::bit_cast<std::uint32_t>(leaf.irradiance.r),
        std::bit_cast<std::uint32_t>(leaf.irradiance.g), std::bit_cast<std::uint32_t>(leaf.irradiance.b)};
    std::uint32_t a = 0x9e3779b9u, b = 0x85ebca6bu;
    for (const std::uint32_t word : words) {
      a = (a ^ word) * 0x9e3779b1u, a ^= a >> 15;
      b = (b ^ word) * 0x85ebca77u, b ^= b >> 13;
    }
    return {finished(a), finished(b)};
  }
  /// Returns the bits mixed by the finaliser of MurmurHash3 (Appleby).
  static constexpr std::uint32_t finished(std::uint32_t x) {
    x = (x ^ x >> 16) * 0x85ebca6bu;
    x = (x ^ x >> 13) * 0xc2b2ae35u;
    return x ^ x >> 16;
  }

  std::uint32_t upper_ = 0, lower_ = 0;
};

}  // namespace alvor
