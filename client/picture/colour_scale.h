#pragma once
// Maps values to positions on the colour map.

#include <vector>

namespace alvor {

/// The values at the ends of the colour map. Requires: low < high, and low > 0 if logarithmic.
struct ColourScale {
  double low = 0;  ///< W/m2
  double high = 1;
  bool logarithmic = false;

  /// Returns the position of `value` in [0, 1]; values outside the scale get its ends.
  double position(double value) const;
};

/// Returns a scale for the positive ones among `values`, of equal weight. It ends at the 1, 2 or 5 x 10^n above all but the top
/// hundredth of them. It begins at 0. A logarithmic scale begins at such a number below all but the bottom hundredth of the
/// positive values, one to four decades below its end.
ColourScale automatic_scale(std::vector<double> values, bool logarithmic);

/// Returns round numbers within the scale, at least one and rarely more than `most`: multiples of 1, 2 or 5 x 10^n. Where a
/// logarithmic scale spans a decade or more, they are such numbers themselves or powers of ten. Requires: most >= 2.
std::vector<double> ticks(const ColourScale& scale, int most);

}  // namespace alvor
