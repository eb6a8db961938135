#pragma once
// Light exchange by gathering everywhere at once, accelerated by generalised conjugate residuals.

#include "radiosity/exchange/coarse_grid.h"
#include "radiosity/exchange/exchange.h"
#include "radiosity/exchange/light_by_leaf.h"
#include "radiosity/exchange/shooting.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// What a system needs. What it does not need takes no time and no memory.
struct GatheringNeeds {
  bool three_bands = true;   ///< false: all bands are equal
  bool acceleration = true;  ///< false: few plain steps do
};

/// A linear system has one unknown a patch and band: the irradiance y by its row, y = F (e + rho y). Each step gathers once at
/// all patches, in parallel, and takes the combination with the directions of the last steps that leaves the smallest residual
/// (GCR, Eisenstat, Elman & Schultz 1983). Bands are systems of their own. One that gains nearly nothing takes a plain step.
/// Before that each step is completed by what a coarse grid makes of the residual, a finer one where light was seen to go round
/// slowly. It needs no transpose of the rows, and its residual, times the reflectance, is the unshot radiosity, of either sign.
/// Results do not depend on the number of threads.
class Gathering : public Exchange {
 public:
  /// Between no patches.
  Gathering() = default;
  /// `leaf_of_place` says where the leaves of patches (consecutive places, as in ShootingPatch) are among `leaf_count` leaves,
  /// `own_radiosity` by place what they emit and reflect of direct light; `hit_leaf` of each patch is by hit of its row.
  /// `irradiance` by patch is where to begin. `ids` by patch; without them there is no coarse grid. Borrows all but the vectors.
  Gathering(std::span<const ShootingPatch> patches, std::span<const std::uint32_t> leaf_of_place, std::size_t leaf_count,
            std::span<const Rgb> own_radiosity, std::vector<const std::uint32_t*> hit_leaf, std::vector<Rgb> irradiance,
            std::vector<PatchId> ids = {}, GatheringNeeds needs = {});

  std::size_t sweep() override;
  double unshot_power() const override { return unshot_power_; }
  Rgb unshot_rms() const override { return unshot_rms_; }
  Rgb mean_radiosity() const override;
  Rgb amplification() const override { return amplification_; }
  std::vector<Rgb> irradiance() const override;
  Rgb ambient_irradiance() const override { return ambient_gain_ * unshot_sum_; }
  std::size_t patch_count() const override { return patches_.size(); }

 private:
  struct Direction {
    std::vector<Rgb> step, change;  // by patch: of the irradiance, and what that takes from the residual
    Rgb norm;                       // of the change, squared
  };
  void gather(std::vector<Rgb>& received);
  Rgb row_times_radiosity(std::size_t patch) const;
  void plain_step();
  void conjugate_step();
  void make_conjugate(Direction& next) const;
  /// By band 1 where the step shortens the residual well enough, else 0.
  Rgb helps(const Rgb& length, const Rgb& overlap) const;
  void advance(const Rgb& length, std::span<const Rgb> step, std::span<const Rgb> change);
  void remember(Direction direction, const Rgb& in_bands);
  std::vector<Rgb> reflectance_seen();
  void coarsen(CoarseUnits units);
  /// Takes a finer coarse grid where the residual falls slowly.
  void watch_decrease();
  /// Sets what leaves each leaf to light(patch, place). In parallel.
  template <class Light>
  void spread(Light&& light);
  void find_own_power();
  void find_unshot();
  Rgb product(std::span<const Rgb> a, std::span<const Rgb> b) const;

  static constexpr std::size_t remembered = 6;
  std::span<const ShootingPatch> patches_;
  std::span<const std::uint32_t> leaf_of_place_;
  std::span<const Rgb> own_radiosity_;
  std::vector<const std::uint32_t*> hit_leaf_;
  bool is_accelerated_ = true;
  LightByLeaf leaving_{0, true};            // what the next gathering finds
  std::vector<Rgb> irradiance_, residual_;  // by patch
  std::vector<Rgb> power_weight_;           // by patch: area times reflectance
  std::vector<Direction> directions_;       // the last ones, in a ring
  std::size_t steps_ = 0;
  std::vector<PatchId> ids_;                  // by patch
  std::vector<std::uint32_t> patch_of_leaf_;  // for the coarse grid
  std::optional<CoarseGrid> coarse_;
  Rgb squares_before_;  // of the residual, when its decrease was last looked at
  std::size_t sweeps_ = 0;
  bool is_finest_ = false;  // of the coarse grids
  double area_ = 0, unshot_power_ = 0;
  Rgb unshot_rms_, unshot_sum_, own_power_, ambient_gain_, amplification_;
};

}  // namespace alvor
