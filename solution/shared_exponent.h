#pragma once
// Three bands in 32 bits: nine bits of mantissa each and an exponent for all (RGB9E5, as OpenGL's EXT_texture_shared_exponent),
// with a scale beside it so that no scene is too dark or too bright.

#include "solution/rgb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace alvor {

/// Bits 0 to 8, 9 to 17 and 18 to 26 are the mantissas of r, g and b, bits 27 to 31 the exponent e: a band is
/// mantissa * 2^(e + scale), rounded to nearest: off by at most 1/511 of the largest band (2^dropped times that) where that is
/// not below 2^(8 + scale).
class SharedExponent {
 public:
  explicit SharedExponent(int scale) : scale_(scale) {
    for (int e = 0; e < exponents; ++e) step_[e] = std::ldexp(1.0, e + scale), per_step_[e] = std::ldexp(1.0, -e - scale);
  }
  int scale() const { return scale_; }
  /// With room for values eight times as large as `largest`, and 2^-36 of it as the smallest step. Requires: largest > 0.
  static SharedExponent for_values_up_to(float largest) { return SharedExponent(std::ilogb(largest) - 8 - (exponents - 5)); }

  /// The largest band that it can hold.
  double largest() const { return 256 * step_.back(); }
  /// The mantissas' lowest `dropped` bits (0 to 7) are 0: what noise would fill costs on the wire. Requires: every band in [0,
  /// largest()].
  std::uint32_t pack(const RgbF& value, int dropped = 0) const {
    const float top = value.max();
    if (!(top > 0)) return 0;
    int e = std::clamp(floor_log2(top) - 8 - scale_, 0, exponents - 1);
    if (mantissa(top, e, dropped) > max_mantissa) ++e;
    return mantissa(value.r, e, dropped) | mantissa(value.g, e, dropped) << 9 | mantissa(value.b, e, dropped) << 18 |
           static_cast<std::uint32_t>(e) << 27;
  }
  RgbF unpack(std::uint32_t word) const {
    const double step = step_[word >> 27];
    const auto band = [&](int shift) { return static_cast<float>(step * (word >> shift & max_mantissa)); };
    return {band(0), band(9), band(18)};
  }

 private:
  static constexpr int exponents = 32;
  static constexpr std::uint32_t max_mantissa = 511;
  static int floor_log2(float x) { return static_cast<int>(std::bit_cast<std::uint32_t>(x) >> 23) - 127; }
  std::uint32_t mantissa(float band, int e, int dropped) const {
    const double steps = std::max(band, 0.0f) * per_step_[e];
    return static_cast<std::uint32_t>(steps / (1 << dropped) + 0.5) << dropped;
  }

  int scale_;
  std::array<double, exponents> step_, per_step_;
};

}  // namespace alvor
