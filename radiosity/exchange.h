#pragma once
// How light goes round between patches that have rows, until nothing is unshot.

#include "solution/rgb.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace alvor {

/// The system x = e + rho F x on its way to its solution, where F are the transport rows, x is the radiosity that was distributed
/// so far, and e + rho F x - x is unshot. Used by one thread at a time.
class Exchange {
 public:
  virtual ~Exchange() = default;
  /// Many steps; returns their number. 0: there is nothing left to do.
  virtual std::size_t sweep() = 0;
  /// |unshot radiosity| times area, W.
  virtual Rgb unshot() const = 0;
  double unshot_power() const { return unshot().sum(); }
  /// |radiosity| by rows so far times area, W: emitted and reflected, but for what direct light does not bring to rows.
  virtual Rgb radiant_power() const = 0;
  /// What a unit of unshot power comes to at most, itself included, before it is absorbed: see alvor::amplification.
  virtual Rgb amplification() const = 0;
  /// By patch: received by rows so far, W/m2.
  virtual std::vector<Rgb> irradiance() const = 0;
  /// Ambient irradiance (Cohen et al. 1988): R times the mean unshot radiosity, with R = 1 / (1 - mean reflectance), each
  /// reflection weakened by what escapes from an open scene.
  virtual Rgb ambient_irradiance() const = 0;
  virtual std::size_t patch_count() const = 0;

  /// Bound on the radiosity that is still to come, of all there is, in the band where it is worst. Where nearly all is reflected
  /// it is far more than what is unshot: a small residual is no small error. It holds up to the noise of rows, as columns of the
  /// system sum to what rows do by reciprocity.
  double remaining_error() const;
};

/// How an exchange ended: with the remaining error asked for, with one that more sweeps would hardly change, or asked to stop.
enum class Settling { settled, stalled, stopped };

/// Sweeps down to `enough` of remaining_error(). It stalls where a thousand steps a patch were not enough, or where for a while
/// none brought a new low: there rounding begins. `after_each` sweep is told its steps and may ask to stop by false.
Settling settle(Exchange& exchange, double enough, const std::function<bool(std::size_t steps)>& after_each);

}  // namespace alvor
