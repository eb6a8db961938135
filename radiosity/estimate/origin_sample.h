#pragma once
// What the rays of one origin of a row tell of the irradiance there.

#include <span>

namespace alvor {

/// The irradiance that the rays of an origin found, and the variance of that value if its rays were independent.
struct OriginSample {
  double irradiance = 0, noise = 0;
};

/// Returns the sample of `rays` rays of weight 1, of which the hits found light that sums to `light`, and its squares to
/// `squares`. Requires: at least two rays.
OriginSample sample_of(double light, double squares, double rays);

/// Returns the sample of guided rays, all of which hit: the mean light, in which each hit counts by its weight. A few guided rays
/// have weights whose sum is far from their number, by which the sum of weighted light errs although all of them find the same
/// light; this mean does not (a ratio estimate: Cochran 1977). Requires: as many weights as lights, at least two, all > 0.
OriginSample sample_of_guided(std::span<const double> light, std::span<const double> weight);

}  // namespace alvor
