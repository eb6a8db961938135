#pragma once
// Three bands in 32 bits: nine bits of mantissa each and one exponent for all (RGB9E5, as in OpenGL's
// EXT_texture_shared_exponent). A scale beside it fits the range of exponents to the scene's brightness.

#include "solution/rgb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace alvor {

/// Packs three bands into a word. Bits 0 to 8, 9 to 17 and 18 to 26 are the mantissas of r, g and b; bits 27 to 31 are the
/// exponent e. A band is mantissa * 2^(e + scale), rounded to nearest. If the largest band is at least 2^(8 + scale), the error
/// is at most 1/511 of it, or 2^dropped times that.
class SharedExponent {
 public:
  explicit SharedExponent(int scale) : scale_(scale) {
    for (int e = 0; e < exponents; ++e) step_[e] = std::ldexp(1.0, e + scale), per_step_[e] = std::ldexp(1.0, -e - scale);
  }
  int scale() const { return scale_; }
  /// Returns a coding that holds values up to eight times `largest`, in steps of at most 2^-35 of it. Requires: largest > 0.
  static SharedExponent for_values_up_to(float largest) { return SharedExponent(std::ilogb(largest) - 8 - (exponents - 5)); }

  /// Returns the largest band value that the coding can hold.
  double largest() const { return 256 * step_.back(); }
  /// Returns the word for `value`. The lowest `dropped` bits (0 to 7) of the mantissas are set to 0: bits that hold only noise do
  /// not compress. Requires: every band in [0, largest()].
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
