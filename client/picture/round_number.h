#pragma once
// Round numbers for scales, and short texts of numbers.

#include <string>

namespace alvor {

/// 1, 2 or 5 times a power of ten.
struct RoundNumber {
  int mantissa = 1;  ///< 1, 2 or 5
  int exponent = 0;

  /// Returns `count` times the number, as the double nearest to the decimal.
  double times(double count) const;
  double value() const { return times(1); }
  RoundNumber next() const;
  RoundNumber previous() const;

  /// Returns the smallest round number that is not below `value`. Requires: value > 0, finite.
  static RoundNumber at_least(double value);
  /// Returns the largest round number that is not above `value`. Requires: value > 0, finite.
  static RoundNumber at_most(double value);
};

/// Returns the shortest text that gives `value` to four digits: "0.02", "150", "2e-6".
std::string short_text(double value);

}  // namespace alvor
