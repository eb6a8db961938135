#pragma once
// The share of a light that a patch sees, by shadow rays.

#include "radiosity/rays/sampling.h"
#include "solution/rgb.h"

#include <array>
#include <cstdint>

namespace alvor {

/// The share of a light that a patch sees: visibility weighted by what each ray would bring, and the light that a medium lets
/// through, summed over shadow rays.
struct VisibleFraction {
  std::array<float, origins_per_patch> weight{}, visible{};
  std::uint32_t rays_per_origin = 0;
  Rgb arriving;  // sum over unblocked rays of weight times transmittance; zero in clear air
  bool any_blocked = false, any_visible = false;

  /// Returns the fraction of a light that nothing hides.
  static VisibleFraction all() {
    VisibleFraction fraction;
    fraction.weight.fill(1);
    fraction.visible.fill(1);
    fraction.any_visible = true;
    fraction.finish();
    return fraction;
  }

  /// Returns whether some rays are blocked and others are not.
  bool mixed() const { return any_blocked && any_visible; }
  /// Returns the visible share of the light, in [0, 1], over all origins.
  double value() const { return all_ > 0 ? all_visible_ / all_ : 0; }
  /// Returns the visible share of the light from origin `o`. It is value() where no ray of the origin has weight, and while
  /// origins have one ray each and these disagree.
  double value(int o) const {
    const bool tells = weight[o] > 0 && (rays_per_origin > 1 || !mixed());
    return tells ? double(visible[o]) / weight[o] : value();
  }
  /// Returns the visible share times the mean transmittance of the medium, per band.
  Rgb dimmed() const { return all_ > 0 ? arriving * (1 / all_) : Rgb{}; }
  /// Returns the variance of value(): half of that of independent rays, because the rays are stratified.
  double variance() const { return mixed() ? 0.5 * value() * (1 - value()) / (rays_per_origin * origins_per_patch) : 0; }
  /// Returns the variance of value(o), mean over origins.
  double origin_variance() const {
    if (!mixed() || rays_per_origin < 2) return 0;
    double sum = 0;
    for (int o = 0; o < origins_per_patch; ++o) sum += value(o) * (1 - value(o));
    return sum / origins_per_patch / (rays_per_origin - 1);
  }
  /// Sums the weights of all origins. value() and what depends on it are valid afterwards.
  void finish() {
    all_ = all_visible_ = 0;
    for (int o = 0; o < origins_per_patch; ++o) all_ += weight[o], all_visible_ += visible[o];
  }

 private:
  double all_ = 0, all_visible_ = 0;
};

}  // namespace alvor
