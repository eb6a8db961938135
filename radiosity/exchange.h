#pragma once
// How light goes round between patches that have rows, until nothing is unshot.

#include "solution/rgb.h"

#include <cstddef>
#include <vector>

namespace alvor {

/// The system x = e + rho F x on its way to its solution, where F are the transport rows, x is the radiosity that was distributed
/// so far, and e + rho F x - x is unshot. Used by one thread at a time.
class Exchange {
 public:
  virtual ~Exchange() = default;
  /// Many steps; returns their number. 0: there is nothing left to do.
  virtual std::size_t sweep() = 0;
  /// |unshot radiosity| times area, summed over bands, W.
  virtual double unshot_power() const = 0;
  /// By patch: received by rows so far, W/m2.
  virtual std::vector<Rgb> irradiance() const = 0;
  /// Ambient irradiance (Cohen et al. 1988): R times the mean unshot radiosity, with R = 1 / (1 - mean reflectance), each
  /// reflection weakened by what escapes from an open scene.
  virtual Rgb ambient_irradiance() const = 0;
};

}  // namespace alvor
