#pragma once
// Light exchange by gathering everywhere at once, accelerated by generalised conjugate residuals.

#include "radiosity/exchange.h"
#include "radiosity/shooting.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// A linear system has one unknown a patch and band: the irradiance y by its row, y = F (e + rho y). Each step gathers once at
/// all patches, in parallel, and takes the combination with the directions of the last steps that leaves the smallest residual
/// (GCR, Eisenstat, Elman & Schultz 1983). Bands are systems of their own. One that gains nearly nothing takes a plain step.
/// It needs no transpose of the rows, and its residual, times the reflectance, is the unshot radiosity, of either sign. Results
/// do not depend on the number of threads.
class Gathering : public Exchange {
 public:
  /// `leaf_of_place` says where the leaves of patches (consecutive places, as in ShootingPatch) are among `leaf_count` leaves,
  /// `own_radiosity` by place what they emit and reflect of direct light; `hit_leaf` of each patch is by hit of its row.
  /// `irradiance` by patch is where to begin. Borrows all but that.
  Gathering(std::span<const ShootingPatch> patches, std::span<const std::uint32_t> leaf_of_place, std::size_t leaf_count,
            std::span<const Rgb> own_radiosity, std::vector<const std::uint32_t*> hit_leaf, std::vector<Rgb> irradiance);

  std::size_t sweep() override;
  Rgb unshot() const override { return unshot_; }
  Rgb radiant_power() const override;
  Rgb amplification() const override { return amplification_; }
  std::vector<Rgb> irradiance() const override;
  Rgb ambient_irradiance() const override { return ambient_gain_ * unshot_sum_; }
  std::size_t patch_count() const override { return patches_.size(); }

  /// By leaf, for rays that hit it: own radiosity and reflected irradiance(). In double precision: where the reflectance is
  /// 0.999999, one part in 10^7 of what goes round once is a tenth of the solution.
  struct alignas(32) Radiosity {
    double r = 0, g = 0, b = 0, unused = 0;
  };
  std::vector<Radiosity> radiosity() const;

 private:
  struct Direction {
    std::vector<Rgb> step, change;  // by patch: of the irradiance, and what that takes from the residual
    Rgb norm;                       // of the change, squared
  };
  void gather(std::vector<Rgb>& received);
  Rgb row_times_radiosity(std::size_t patch) const;
  void make_conjugate(Direction& next) const;
  /// By band 1 where the step shortens the residual well enough, else 0.
  Rgb helps(const Rgb& length, const Rgb& overlap) const;
  void advance(const Rgb& length, std::span<const Rgb> step, std::span<const Rgb> change);
  void remember(Direction direction, const Rgb& in_bands);
  std::vector<Rgb> reflectance_seen();
  /// Sets what leaves each leaf to leaving(patch, place). In parallel.
  template <class Leaving>
  void spread(std::span<Radiosity> by_leaf, Leaving&& leaving) const;
  void find_own_power();
  void find_unshot();
  Rgb product(std::span<const Rgb> a, std::span<const Rgb> b) const;

  static constexpr std::size_t remembered = 6;
  std::span<const ShootingPatch> patches_;
  std::span<const std::uint32_t> leaf_of_place_;
  std::span<const Rgb> own_radiosity_;
  std::vector<const std::uint32_t*> hit_leaf_;
  std::vector<Radiosity> leaving_;          // by leaf: what the next gathering finds
  std::vector<Rgb> irradiance_, residual_;  // by patch
  std::vector<Rgb> power_weight_;           // by patch: area times reflectance
  std::vector<Direction> directions_;       // the last ones, in a ring
  std::size_t steps_ = 0;
  Rgb unshot_, unshot_sum_, own_power_, ambient_gain_, amplification_;
};

}  // namespace alvor
