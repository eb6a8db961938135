#pragma once

#include <random>

namespace alvor::bench {

/// A random number generator that gives the same numbers for the same seed with every standard library.
class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  int below(int end) { return static_cast<int>(engine_() % static_cast<unsigned>(end)); }
  double between(double low, double high) { return low + (high - low) * below(10000) / 10000; }

 private:
  std::minstd_rand engine_;
};

}  // namespace alvor::bench
