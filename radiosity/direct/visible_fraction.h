#pragma once
// The share of a light that a patch sees, by shadow rays.

#include "radiosity/rays/sampling.h"
#include "solution/rgb.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace alvor {

/// The share of a light that a patch sees: visibility weighted by what each ray would bring, and the light that a medium and
/// panes let through, summed over shadow rays.
struct VisibleFraction {
  std::array<float, origins_per_patch> weight{}, visible{};
  std::array<float, origins_per_patch> squared_weight{};
  std::uint32_t rays_per_origin = 0;
  int ray_level = 0;          ///< see Receiver
  Rgb arriving;               // sum over unblocked rays of weight times transmittance; zero in clear air without panes
  float least = 1, most = 0;  ///< of the shares that rays let through: 0 where blocked, the mean tint of panes, else 1

  /// Returns the fraction of a light that nothing hides.
  static VisibleFraction all() {
    VisibleFraction fraction;
    fraction.weight.fill(1);
    fraction.visible.fill(1);
    fraction.squared_weight.fill(1);
    fraction.arriving = double(origins_per_patch) * Rgb{1, 1, 1};
    fraction.count(1);
    fraction.finish();
    return fraction;
  }

  /// Notes that a ray lets this share of light through.
  void count(float share) {
    least = std::min(least, share);
    most = std::max(most, share);
  }
  /// Returns whether rays differ: some are blocked and others are not, or cross other panes.
  bool mixed() const { return least < most; }
  /// Returns the visible share of the light, in [0, 1], over all origins.
  double value() const { return all_ > 0 ? all_visible_ / all_ : 0; }
  /// Returns the visible share of the light from origin `o`. It is value() where no ray of the origin has weight, and while
  /// origins have one ray each and these disagree.
  double value(int o) const {
    const bool tells = weight[o] > 0 && (rays_per_origin > 1 || !mixed());
    return tells ? double(visible[o]) / weight[o] : value();
  }
  /// Returns the visible share times the mean transmittance of medium and panes, per band.
  Rgb dimmed() const { return all_ > 0 ? arriving * (1 / all_) : Rgb{}; }
  /// Returns the variance of value(): half of that of independent rays that let through `least` or `most`, because the rays are
  /// stratified. Rays of different weight count as fewer: (sum of weights)^2 / (sum of their squares) (Kish 1965).
  double variance() const {
    return mixed() && all_ > 0 ? 0.5 * share_of_spread() * spread(value()) * all_squares_ / (all_ * all_) : 0;
  }
  /// Returns the variance of value(o), mean over origins, as if the rays of an origin were independent. Where the share of an
  /// origin is counted, the rays of all count as one more of its own: one ray, or one that outweighs the others, never disagrees
  /// with itself.
  double origin_variance() const {
    if (!mixed() || rays_per_origin < 2) return 0;
    double sum = 0;
    for (int o = 0; o < origins_per_patch; ++o) {
      if (weight[o] <= 0) continue;
      const double rays = double(weight[o]) * weight[o] / squared_weight[o];
      sum += spread((rays * value(o) + value()) / (rays + 1)) / rays;
    }
    return share_of_spread() * sum / origins_per_patch;
  }
  /// Sums the weights of all origins. value() and what depends on it are valid afterwards.
  void finish() {
    all_ = all_visible_ = all_squares_ = 0;
    for (int o = 0; o < origins_per_patch; ++o) all_ += weight[o], all_visible_ += visible[o], all_squares_ += squared_weight[o];
  }

 private:
  /// Returns the variance of shares with this mean that are all `least` or `most`: no shares between them vary more (Bhatia &
  /// Davis 2000).
  double spread(double mean) const { return std::max(0.0, (mean - least) * (most - mean)); }

  /// Returns the share of the variance of independent rays that four times as many rays at each level keep: those of a net that
  /// cross one edge vary as the inverse of their number to the power of 1.5. Under the sky in a deep window, variances over seeds
  /// are 0.19, 0.2, 0.19 and 0.6 of what is told at the four levels (docs/design/direct-light.md).
  double share_of_spread() const { return 1.0 / (1 << ray_level); }

  double all_ = 0, all_visible_ = 0, all_squares_ = 0;
};

}  // namespace alvor
