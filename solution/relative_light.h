#pragma once
// Light as the solver counts it.

#include "solution/rgb.h"

namespace alvor {

class EmissionUnit;

/// Light per band in emission units: radiosity or irradiance, and power if multiplied by m2. Only EmissionUnit converts between
/// RelativeLight and W/m2.
using RelativeLight = RgbOf<double, EmissionUnit>;

/// Multiplies band by band, as reflectance times irradiance.
constexpr RelativeLight operator*(const Rgb& factor, const RelativeLight& light) {
  return {factor.r * light.r, factor.g * light.g, factor.b * light.b};
}
/// Returns the ratio of two lights, band by band.
constexpr Rgb operator/(const RelativeLight& a, const RelativeLight& b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }
/// Returns the product of two lights, band by band, in emission units squared.
constexpr Rgb product(const RelativeLight& a, const RelativeLight& b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }

}  // namespace alvor
