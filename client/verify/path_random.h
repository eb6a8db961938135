#pragma once
// Random numbers for paths.

#include "solution/patch_id.h"

#include <cstdint>

namespace alvor {

/// A point of the unit square.
struct UnitPair {
  double u = 0, v = 0;
};

/// Independent uniform random numbers (SplitMix64, Steele et al. 2014). Seed, point and round select the stream.
class PathRandom {
 public:
  PathRandom(std::uint64_t seed, std::uint64_t point, std::uint64_t round)
      : state_(mix_bits(seed + mix_bits(point + mix_bits(round)))) {}

  std::uint64_t bits() { return mix_bits(state_ += 0x9e3779b97f4a7c15u); }
  /// Returns a number in [0, 1).
  double number() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  UnitPair pair() {
    const std::uint64_t both = bits();
    return {static_cast<double>(both >> 32) * 0x1p-32, static_cast<double>(both & 0xffffffffu) * 0x1p-32};
  }

 private:
  std::uint64_t state_;
};

/// Points that fill the unit square evenly: a (0,2)-sequence (Sobol 1967) with randomly flipped binary digits. Each point is
/// uniformly distributed, so means over any number of them are unbiased.
class EvenPairs {
 public:
  explicit EvenPairs(PathRandom& random) : flips_(random.bits()) {}

  UnitPair operator[](std::uint32_t n) const {
    std::uint32_t u = 0, v = 0;
    for (std::uint32_t bit = 1u << 31, direction = bit; n != 0; n >>= 1, bit >>= 1, direction ^= direction >> 1)
      if (n & 1) u ^= bit, v ^= direction;
    return {(u ^ static_cast<std::uint32_t>(flips_ >> 32)) * 0x1p-32, (v ^ static_cast<std::uint32_t>(flips_)) * 0x1p-32};
  }

 private:
  std::uint64_t flips_;
};

}  // namespace alvor
