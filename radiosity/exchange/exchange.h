#pragma once
// Iterative solution of the exchange of light between patches that have rows, until nothing is unshot.

#include "solution/relative_light.h"

#include <cstddef>
#include <functional>
#include <vector>

namespace alvor {

/// The system x = e + rho F x while it is being solved. F are the transport rows, x is the radiosity distributed so far, and
/// e + rho F x - x is the unshot radiosity. Used by one thread at a time.
class Exchange {
 public:
  virtual ~Exchange() = default;
  /// Makes many steps (patches shot or gathered) and returns their number. 0: there is nothing left to do.
  virtual std::size_t sweep() = 0;
  /// Returns |unshot radiosity| times area, summed over patches and bands, in emission units times m2.
  virtual double unshot_power() const = 0;
  /// Returns the RMS of the unshot radiosity over the area, per band.
  virtual RelativeLight unshot_rms() const = 0;
  /// Returns the mean over the area of the magnitude of the radiosity, distributed and unshot, per band. Emission that rows do
  /// not carry is not in it.
  virtual RelativeLight mean_radiosity() const = 0;
  /// Returns a bound on all light that unshot radiosity becomes before it is absorbed, itself included, as a multiple of it
  /// (RMS), per band: see alvor::amplification.
  virtual Rgb amplification() const = 0;
  /// Returns the irradiance that each patch received by its row so far.
  virtual std::vector<RelativeLight> irradiance() const = 0;
  /// Returns the ambient irradiance (Cohen et al. 1988): R times the mean unshot radiosity, with R = 1 / (1 - mean reflectance).
  /// In an open scene each reflection is weakened by the share of light that escapes.
  virtual RelativeLight ambient_irradiance() const = 0;
  virtual std::size_t patch_count() const = 0;
  /// Returns the radiosity that each leaf has shot, patch after patch. Empty if light is gathered.
  virtual std::vector<RelativeLight> shot() const { return {}; }
  /// Gives back memory that only makes later sweeps gain more.
  virtual void forget_directions() {}
  /// Tells the remaining_error() at which the caller will stop. An exchange may then skip preparations that pay only over many
  /// sweeps. Without this call it is 0.
  virtual void expect_sweeps_down_to(double) {}

  /// Returns a bound on the radiosity that is still to come: its RMS over the mean radiosity, in the worst band. Where nearly all
  /// light is reflected it is far more than the unshot radiosity: a small residual is no small error. It holds as far as rows are
  /// reciprocal, so up to their noise.
  double remaining_error() const;
};

/// How settle() ended: the remaining error is as small as asked for, more sweeps would hardly change it, or `after_each` stopped
/// it.
enum class Settling { settled, stalled, stopped };

/// Sweeps until remaining_error() is at most `enough`. Gives up (`stalled`) after 1000 steps per patch, or after 64 steps per
/// patch without a new lowest error, where rounding begins. After each sweep it calls after_each(number of steps), which returns
/// false to stop.
Settling settle(Exchange& exchange, double enough, const std::function<bool(std::size_t steps)>& after_each);

}  // namespace alvor
