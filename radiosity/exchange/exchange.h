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
  /// |unshot radiosity| times area, summed over bands, W.
  virtual double unshot_power() const = 0;
  /// Root of the mean square of unshot radiosity over the area, W/m2.
  virtual Rgb unshot_rms() const = 0;
  /// Mean of radiosity as far as rows know it, distributed and unshot, over the area, W/m2.
  virtual Rgb mean_radiosity() const = 0;
  /// What unshot radiosity may come to before it is absorbed, itself included: see alvor::amplification.
  virtual Rgb amplification() const = 0;
  /// By patch: received by rows so far, W/m2.
  virtual std::vector<Rgb> irradiance() const = 0;
  /// Ambient irradiance (Cohen et al. 1988): R times the mean unshot radiosity, with R = 1 / (1 - mean reflectance), each
  /// reflection weakened by what escapes from an open scene.
  virtual Rgb ambient_irradiance() const = 0;
  virtual std::size_t patch_count() const = 0;
  /// Returns the radiosity that each leaf has shot, patch after patch, where light is exchanged by shots; empty where it is
  /// gathered.
  virtual std::vector<Rgb> shot() const { return {}; }

  /// Bound on what is still to come: RMS over the mean radiosity, in the band where it is worst. Where nearly all is reflected it
  /// is far more than what is unshot: a small residual is no small error. It holds as far as rows are reciprocal, so up to their
  /// noise.
  double remaining_error() const;
};

/// How an exchange ended: with the remaining error asked for, with one that more sweeps would hardly change, or asked to stop.
enum class Settling { settled, stalled, stopped };

/// Sweeps down to `enough` of remaining_error(). It stalls where a thousand steps a patch were not enough, or where for a while
/// none brought a new low: there rounding begins. `after_each` sweep is told its steps and may ask to stop by false.
Settling settle(Exchange& exchange, double enough, const std::function<bool(std::size_t steps)>& after_each);

}  // namespace alvor
