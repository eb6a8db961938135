#pragma once

#include "radiosity/rays/sampling.h"

#include <cmath>
#include <cstddef>

namespace alvor::test {

/// Random numbers that are the same for the same seed with every standard library.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : random_(seed, PatchId::root(0)) {}
  double between(double low, double high) { return low + (high - low) * random_.next(); }
  /// Returns a number whose logarithm is uniform. Requires: 0 < low <= high.
  double magnitude(double low, double high) { return low * std::pow(high / low, random_.next()); }
  /// Returns an integer in [0, end).
  std::uint32_t below(std::size_t end) { return random_.next_below(static_cast<std::uint32_t>(end)); }
  bool happens(double probability) { return random_.next() < probability; }
  template <class T, std::size_t n>
  T one_of(const T (&choices)[n]) {
    return choices[below(n)];
  }
  std::uint64_t bits() { return static_cast<std::uint64_t>(random_.next() * 0x1p53); }

 private:
  RandomStream random_;
};

}  // namespace alvor::test
