#pragma once
// Strategies: the order in which patches shoot or gather.

#include "radiosity/exchange/exchange.h"
#include "radiosity/exchange/shooting.h"

#include <cstddef>
#include <memory>
#include <string_view>

namespace alvor {

/// How light is exchanged. All strategies end at the same solution; they differ in how fast they come near it.
enum class Strategy {
  automatic,  ///< the fastest: gathering at all patches at once (radiosity/exchange/gathering.h), displayed with the ambient term
  sorted,     ///< shooting, largest unshot power first (Cohen et al. 1988)
  sorted_ambient,  ///< `sorted`, displayed with the ambient term
  gather,          ///< Gauss-Seidel over the full system, in the order of the patches
  shoot,           ///< shooting in the order of the patches
  overshoot,       ///< sorted shooting of unshot + rho ambient; excess is taken back by negative shots (Feda & Purgathofer 1992)
};

/// Returns the strategy's name in options and tables, for example "sorted+ambient".
std::string_view text(Strategy strategy);
/// Returns whether the ambient term is added to the displayed radiosity.
bool shows_ambient(Strategy strategy);

/// Takes a system towards its solution, step by step. All steppers measure the rest by one residual, Shooting::unshot_power.
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Shoots or gathers one patch. Returns false if there is nothing left to do. Patches with nothing to shoot are passed over.
  virtual bool step() = 0;
  /// Makes many steps and returns their number. Sorted strategies shoot, in the order of the patches, those above half of the
  /// largest unshot power. The unshot radiosity is known afterwards.
  virtual std::size_t sweep() = 0;
};

/// Returns a stepper that borrows the system. `automatic` has no steps of one patch: its stepper is that of `sorted`. Requires:
/// the unshot radiosity of the system is known (Shooting::find_unshot).
std::unique_ptr<Stepper> make_stepper(Strategy strategy, Shooting& system);

/// An exchange of light by a strategy that takes one patch at a time: a system and its stepper.
class ShotExchange : public Exchange {
 public:
  /// Requires: the unshot radiosity of the system is known; the system's patches live longer than this.
  ShotExchange(Shooting system, Strategy strategy) : system_(std::move(system)), stepper_(make_stepper(strategy, system_)) {}
  ShotExchange(const ShotExchange&) = delete;
  ShotExchange& operator=(const ShotExchange&) = delete;

  std::size_t sweep() override { return stepper_->sweep(); }
  double unshot_power() const override { return system_.unshot_power(); }
  RelativeLight unshot_rms() const override { return system_.unshot_rms(); }
  RelativeLight mean_radiosity() const override { return system_.mean_radiosity(); }
  Rgb amplification() const override { return system_.amplification(); }
  std::vector<RelativeLight> irradiance() const override { return system_.irradiance(); }
  RelativeLight ambient_irradiance() const override { return system_.ambient_irradiance(); }
  std::size_t patch_count() const override { return system_.patch_count(); }
  std::vector<RelativeLight> shot() const override { return system_.shot(); }

 private:
  Shooting system_;
  std::unique_ptr<Stepper> stepper_;
};

}  // namespace alvor
