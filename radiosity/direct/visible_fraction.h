#pragma once
// How much of an emitter a patch sees, from shadow rays.

#include "radiosity/rays/sampling.h"
#include "solution/rgb.h"

#include <array>
#include <cstdint>

namespace alvor {

/// Kernel-weighted visibility, and what a medium lets through of it, summed over shadow rays.
struct VisibleFraction {
  std::array<float, origins_per_patch> weight{}, visible{};
  std::uint32_t rays_per_origin = 0;
  Rgb arriving;  // of `visible`, where there is a medium
  bool any_blocked = false, any_visible = false;

  /// Of an emitter that nothing hides.
  static VisibleFraction all() {
    VisibleFraction fraction;
    fraction.weight.fill(1);
    fraction.visible.fill(1);
    fraction.any_visible = true;
    fraction.finish();
    return fraction;
  }

  bool mixed() const { return any_blocked && any_visible; }
  double value() const { return all_ > 0 ? all_visible_ / all_ : 0; }
  /// At an origin, where enough rays tell; elsewhere as everywhere.
  double value(int o) const {
    const bool tells = weight[o] > 0 && (rays_per_origin > 1 || !mixed());
    return tells ? double(visible[o]) / weight[o] : value();
  }
  Rgb dimmed() const { return all_ > 0 ? arriving * (1 / all_) : Rgb{}; }
  /// Of value(): half of what independent rays would have, because they are stratified.
  double variance() const { return mixed() ? 0.5 * value() * (1 - value()) / (rays_per_origin * origins_per_patch) : 0; }
  /// Mean over origins of the variance of value(o).
  double origin_variance() const {
    if (!mixed() || rays_per_origin < 2) return 0;
    double sum = 0;
    for (int o = 0; o < origins_per_patch; ++o) sum += value(o) * (1 - value(o));
    return sum / origins_per_patch / (rays_per_origin - 1);
  }
  /// Sums up what was counted so far.
  void finish() {
    all_ = all_visible_ = 0;
    for (int o = 0; o < origins_per_patch; ++o) all_ += weight[o], all_visible_ += visible[o];
  }

 private:
  double all_ = 0, all_visible_ = 0;
};

}  // namespace alvor
