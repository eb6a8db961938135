#pragma once
// The numbers that people like to read on a scale.

#include <string>

namespace alvor {

/// 1, 2 or 5 times a power of ten.
struct RoundNumber {
  int mantissa = 1;  ///< 1, 2 or 5
  int exponent = 0;

  /// `count` times the number; the double nearest to the decimal.
  double times(double count) const;
  double value() const { return times(1); }
  RoundNumber next() const;
  RoundNumber previous() const;

  /// The least that is not below `value`, or the greatest not above it. Requires: value > 0, finite.
  static RoundNumber at_least(double value);
  static RoundNumber at_most(double value);
};

/// The fewest digits that give `value` to four of them: "0.02", "150", "2e-6".
std::string short_text(double value);

}  // namespace alvor
