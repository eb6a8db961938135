#pragma once
// In which order patches shoot or gather.

#include "radiosity/exchange/exchange.h"
#include "radiosity/exchange/shooting.h"

#include <cstddef>
#include <memory>
#include <string_view>

namespace alvor {

/// All of them end at the same solution; what they know of it on the way differs.
enum class Strategy {
  automatic,  ///< the best one known: gathering everywhere at once (radiosity/exchange/gathering.h), displayed with the ambient
              ///< term
  sorted,     ///< shooting, largest unshot power first (Cohen et al. 1988)
  sorted_ambient,  ///< the same, displayed with the ambient term
  gather,          ///< Gauss-Seidel over the full system, in the order of the patches
  shoot,           ///< shooting in the order of the patches
  overshoot,       ///< sorted shooting of unshot + rho ambient; what was too much is taken back (Feda & Purgathofer 1992)
};

/// As options and tables name it: "sorted+ambient".
std::string_view text(Strategy strategy);
/// Whether the ambient term is added to what is displayed.
bool shows_ambient(Strategy strategy);

/// Takes a system towards its solution. All measure what is left by the same residual, Shooting::unshot_power.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Shoots or gathers one patch. False if there is nothing left to do. Among patches that have nothing to shoot the order goes
  /// on without a step.
  virtual bool step() = 0;
  /// Many steps, in the order of the patches where that is nearly as good; returns their number. What is unshot is known
  /// afterwards.
  virtual std::size_t sweep() = 0;
};

/// Borrows the system. Requires: what is unshot is known (Shooting::find_unshot). `automatic` has no steps of one patch: in its
/// place comes `sorted`.
std::unique_ptr<Stepper> make_stepper(Strategy strategy, Shooting& system);

/// A system and what takes it to its solution.
class ShotExchange : public Exchange {
 public:
  /// Requires: what is unshot is known; its patches live longer.
  ShotExchange(Shooting system, Strategy strategy) : system_(std::move(system)), stepper_(make_stepper(strategy, system_)) {}
  ShotExchange(const ShotExchange&) = delete;
  ShotExchange& operator=(const ShotExchange&) = delete;

  std::size_t sweep() override { return stepper_->sweep(); }
  double unshot_power() const override { return system_.unshot_power(); }
  Rgb unshot_rms() const override { return system_.unshot_rms(); }
  Rgb mean_radiosity() const override { return system_.mean_radiosity(); }
  Rgb amplification() const override { return system_.amplification(); }
  std::vector<Rgb> irradiance() const override { return system_.irradiance(); }
  Rgb ambient_irradiance() const override { return system_.ambient_irradiance(); }
  std::size_t patch_count() const override { return system_.patch_count(); }
  std::vector<Rgb> shot() const override { return system_.shot(); }

 private:
  Shooting system_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace alvor
