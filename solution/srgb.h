#pragma once
// The transfer function of sRGB (IEC 61966-2-1).

#include <cmath>

namespace alvor {

/// Returns the linear value of an encoded one, both in [0, 1].
inline double linear_of_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Returns the encoded value of a linear one, both in [0, 1].
inline double srgb_of_linear(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace alvor
