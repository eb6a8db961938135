#pragma once
// The irradiance at an origin of a transport row, one of sixteen points of its patch, as the rays that start there tell it.

namespace alvor {

/// The irradiance that the rays of an origin found, mean over bands, and the variance of that value if the rays were independent.
struct OriginSample {
  double irradiance = 0, noise = 0;
};

/// Returns the sample of an origin's `rays` rays: `light` sums weight times light over them, `squares` the squares of these
/// products. A ray without a hit adds nothing to either. Requires: at least two rays.
OriginSample sample_of(double light, double squares, double rays);

/// The sample of an origin whose rays are guided. The weights of a few guided rays add up to much less or more than their number,
/// so that the sum of weighted light errs although all of them find the same light. Only what each ray finds beyond the light
/// `around` it, such as the mean of its row, is therefore weighted (a difference estimate: Cochran 1977). The irradiance is right
/// on average whatever `around` is, if that does not depend on these rays.
class GuidedOrigin {
 public:
  explicit GuidedOrigin(double around) : around_(around) {}

  /// Adds a ray that hit; rays that did not must not be left out.
  void add(double light, double weight) {
    const double beyond = weight * (light - around_);
    sum_ += beyond, squares_ += beyond * beyond, rays_ += 1;
  }
  /// Requires: at least two rays.
  OriginSample sample() const {
    const OriginSample beyond = sample_of(sum_, squares_, rays_);
    return {around_ + beyond.irradiance, beyond.noise};
  }

 private:
  double around_, sum_ = 0, squares_ = 0, rays_ = 0;
};

}  // namespace alvor
