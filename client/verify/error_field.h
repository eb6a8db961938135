#pragma once
// The error between the points where it was measured.

#include "client/verify/verification.h"

#include <array>
#include <cstddef>
#include <vector>

namespace alvor {

/// Signed relative error of a solution anywhere on its surfaces: that of the light at the points around, near ones first, which
/// face the same way (inverse distance weighting, Shepard 1968). Errors and truths are averaged apart, so that dark, noisy points
/// do not stand out, and what may be noise of the truth is taken out (James and Stein 1961). Immutable; safe from any thread.
class ErrorField {
 public:
  /// Requires: at least one point that counts.
  explicit ErrorField(const Verification& verification);

  struct Value {
    double error = 0;     ///< (solution - truth) / truth; 0 where nothing faces this way
    double distance = 0;  ///< to the nearest point that faces this way, metres
  };
  /// Linear in the number of points. `normal` is unit.
  Value at(Vec3 place, Vec3 normal) const;

 private:
  static constexpr std::size_t width = 8;
  /// Points side by side, as SIMD wants them, relative to centre_ in units of spacing_. What fills up the last has no weight.
  struct Group {
    std::array<float, width> x{}, y{}, z{}, normal_x{}, normal_y{}, normal_z{}, error{}, truth{}, variance{};
  };

  /// Weighted sums over points.
  struct Sums {
    double error = 0, truth = 0, variance = 0;
    float nearest = 0;  ///< squared distance
  };
  Sums sums_around(const std::array<float, 3>& place, const std::array<float, 3>& normal) const;

  std::vector<Group> groups_;
  Vec3 centre_;
  double spacing_ = 1;  ///< about how far points are apart, metres
};

}  // namespace alvor
