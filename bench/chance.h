#pragma once

#include <random>

namespace alvor::bench {

/// The same numbers from the same seed, whatever the standard library.
class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  int below(int end) { return static_cast<int>(engine_() % static_cast<unsigned>(end)); }
  double between(double low, double high) { return low + (high - low) * below(10000) / 10000; }

 private:
  std::minstd_rand engine_;
};

}  // namespace alvor::bench
