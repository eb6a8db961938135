#pragma once
// Light exchange by gathering at all patches at once, accelerated by generalised conjugate residuals.

#include "radiosity/exchange/coarse_grid.h"
#include "radiosity/exchange/exchange.h"
#include "radiosity/exchange/light_by_leaf.h"
#include "radiosity/exchange/shooting.h"
#include "radiosity/ranks/deal.h"

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// Which parts of the method a system needs. A part that is off takes no time and no memory.
struct GatheringNeeds {
  bool three_bands = true;   ///< false: all bands are equal
  bool acceleration = true;  ///< false: only plain steps, for systems that need few of them
};

/// The ranks that gather together, and which of them has the hits of each patch's row.
struct GatheringRanks {
  Ranks& ranks = Ranks::alone();
  Deal patches;
};

/// The exchange of light as a linear system with one unknown per patch and band: y = F (e + R y), the irradiance by the patch's
/// row. R reflects irradiance, and lets it through to the patch behind a translucent one. Each sweep gathers once at all patches,
/// in parallel. A coarse grid first improves the residual to a step; a finer grid takes its place if the residual falls slowly
/// and is far from where it is to be.
/// The step is then combined with the last six directions so that the smallest residual is left (GCR, Eisenstat, Elman & Schultz
/// 1983). Bands are systems of their own; a band that gains less than 1 % takes the step without combination. No transpose of the
/// rows is needed. R times the residual is the unshot radiosity, of either sign. Results do not depend on the number of threads,
/// nor of ranks: each rank gathers at its patches, and does all else for all patches. The constructor and sweep() are
/// collectives.
class Gathering : public Exchange {
 public:
  /// Makes an exchange between no patches.
  Gathering() = default;
  /// Begins at `irradiance` (by patch). Places number the leaves of all patches, patch after patch, as in ShootingPatch;
  /// `leaf_of_place` is the leaf at each place, among `leaf_count` leaves. `own_radiosity` (by place) is a leaf's emission and
  /// reflected direct light. `hit_leaf` of each patch are the leaves that the hits of its row find. `ids` (by patch) may be
  /// empty; then there is no coarse grid. `leaf_reflectance` (by place) may be empty; then that of the patch counts. Borrows all
  /// but the vectors.
  Gathering(std::span<const ShootingPatch> patches, std::span<const std::uint32_t> leaf_of_place, std::size_t leaf_count,
            std::span<const RelativeLight> own_radiosity, std::vector<const std::uint32_t*> hit_leaf,
            std::vector<RelativeLight> irradiance, std::vector<PatchId> ids = {}, GatheringNeeds needs = {},
            std::span<const Rgb> leaf_reflectance = {}, GatheringRanks of_ranks = {});

  std::size_t sweep() override;
  double unshot_power() const override { return unshot_power_; }
  RelativeLight unshot_rms() const override { return unshot_rms_; }
  RelativeLight mean_radiosity() const override;
  Rgb amplification() const override { return amplification_; }
  std::vector<RelativeLight> irradiance() const override;
  RelativeLight ambient_irradiance() const override { return ambient_gain_ * unshot_sum_; }
  std::size_t patch_count() const override { return patches_.size(); }
  void forget_directions() override;
  void expect_sweeps_down_to(double remaining_error) override { enough_ = remaining_error; }

 private:
  /// A search direction, by patch: a step of the irradiance, and the change that it takes away from the residual.
  struct Direction {
    std::vector<RelativeLight> step, change;
    Rgb norm;  // product of `change` with itself
  };
  void gather(std::vector<RelativeLight>& received);
  RelativeLight row_times_radiosity(std::size_t patch) const;
  void plain_step();
  void conjugate_step();
  /// Takes from `next` its part along each of the remembered directions. Returns these parts, as multiples of the directions.
  std::vector<Rgb> make_conjugate(Direction& next) const;
  /// Returns 1 for each band in which the step reduces the squared residual by more than 1 %, else 0.
  Rgb helps(const Rgb& length, const Rgb& overlap) const;
  void advance(const Rgb& length, std::span<const RelativeLight> step, std::span<const RelativeLight> change);
  void remember(Direction direction, const Rgb& in_bands);
  void find_amplification();
  std::vector<Rgb> albedo_seen();
  void coarsen(CoarseUnits units);
  /// Looks at the residual every four sweeps and takes a finer coarse grid if it falls by less than half per sweep, and many
  /// sweeps are left.
  void watch_decrease();
  const Rgb& reflectance(std::size_t patch, std::uint32_t place) const {
    return reflectance_.empty() ? patches_[patch].reflectance : reflectance_[place];
  }
  /// Returns the part of the irradiance `received`, by patch, that leaves a patch because the patch behind it received it.
  RelativeLight from_behind(std::size_t patch, std::span<const RelativeLight> received) const {
    const std::uint32_t behind = patches_[patch].behind;
    return behind == ShootingPatch::none ? RelativeLight{} : patches_[behind].diffuse_transmittance * received[behind];
  }
  /// Sets the light that leaves each leaf to the reflected and transmitted part of the irradiance `received`, by patch, and
  /// own(place). In parallel.
  template <class Own>
  void spread(std::span<const RelativeLight> received, Own&& own);
  void spread(std::span<const RelativeLight> received);
  void find_own_power();
  void find_unshot();
  /// Returns the scalar product of two functions of the patches, weighted by area, per band, in emission units squared times m2.
  Rgb product(std::span<const RelativeLight> a, std::span<const RelativeLight> b) const;

  static constexpr std::size_t remembered =
      6;  // directions kept; each takes 6 numbers per patch. Chosen; half: the same, double: the same (docs/design/constants.md)
  std::span<const ShootingPatch> patches_;
  std::span<const std::uint32_t> leaf_of_place_;
  std::span<const RelativeLight> own_radiosity_;
  std::span<const Rgb> reflectance_;
  std::vector<const std::uint32_t*> hit_leaf_;
  GatheringRanks of_ranks_;
  bool is_accelerated_ = true;
  LightByLeaf leaving_{0, true};                      // light that the next gathering finds at each leaf
  std::vector<RelativeLight> irradiance_, residual_;  // by patch
  std::vector<Rgb> power_weight_;                     // by patch: area times albedo
  std::vector<Direction> directions_;                 // the last directions, in a ring
  std::size_t steps_ = 0;
  std::vector<PatchId> ids_;                  // by patch
  std::vector<std::uint32_t> patch_of_leaf_;  // for the coarse grid
  std::optional<CoarseGrid> coarse_;
  Rgb squares_before_;  // squared residual when watch_decrease() looked at it last
  std::size_t sweeps_ = 0;
  double enough_ = 0;       // remaining error down to which light is exchanged
  bool is_finest_ = false;  // the coarse grid has been replaced by the finer one
  double area_ = 0, unshot_power_ = 0;
  RelativeLight unshot_rms_, unshot_sum_, own_power_;
  Rgb ambient_gain_, amplification_;
};

}  // namespace alvor
