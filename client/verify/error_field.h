#pragma once
// Interpolates the error of a solution between the points where it was measured.

#include "client/verify/verification.h"

#include <array>
#include <cstddef>
#include <vector>

namespace alvor {

/// The signed relative error of a solution anywhere on its surfaces, interpolated between points that face the same way (inverse
/// distance weighting, Shepard 1968). Errors and truths are averaged separately, so that dark, noisy points do not stand out; the
/// part that may be noise of the truth is removed (James and Stein 1961). Immutable; safe from any thread.
class ErrorField {
 public:
  /// Requires: at least one point of `verification` counts.
  explicit ErrorField(const Verification& verification);

  struct Value {
    double error = 0;     ///< (solution - truth) / truth; 0 where nothing faces this way
    double distance = 0;  ///< to the nearest point that faces this way, metres
  };
  /// Returns the interpolated error. Linear in the number of points. `normal` is unit.
  Value at(Vec3 place, Vec3 normal) const;

 private:
  static constexpr std::size_t width = 8;
  /// Eight points for SIMD, relative to centre_ in units of spacing_. Unused places of the last group have no weight.
  struct Group {
    std::array<float, width> x{}, y{}, z{}, normal_x{}, normal_y{}, normal_z{}, error{}, truth{}, variance{};
  };

  /// Weighted sums over points, and the squared distance of the nearest.
  struct Sums {
    double error = 0, truth = 0, variance = 0;
    float nearest = 0;  ///< squared distance
  };
  Sums sums_around(const std::array<float, 3>& place, const std::array<float, 3>& normal) const;

  std::vector<Group> groups_;
  Vec3 centre_;
  double spacing_ = 1;  ///< typical distance between points, metres
};

}  // namespace alvor
