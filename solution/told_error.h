#pragma once
// The told errors of leaves: one byte each, on a logarithmic scale.

#include "solution/patch_id.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace alvor {

/// Packs an error (one standard deviation of the mean of the bands, W/m2) into a byte. Code 0 is an error of 0; code c, from 1 to
/// 255, is 2^(scale + c / 8). So an error is rounded by at most 4.5 %, and the smallest is a four-billionth of the largest.
class ErrorCoding {
 public:
  static constexpr int farthest_scale = 200;  ///< scales lie in [-200, 200]

  explicit ErrorCoding(int scale) : scale_(scale) {}
  /// Returns a coding that holds `largest`, which is finite.
  static ErrorCoding for_errors_up_to(float largest) {
    return ErrorCoding(largest > 0 ? std::max(std::ilogb(largest) + 1 - octaves, -farthest_scale) : 0);
  }

  int scale() const { return scale_; }
  std::uint8_t pack(float error) const {
    if (!(error > 0)) return 0;
    return static_cast<std::uint8_t>(std::clamp(std::lround(codes_per_octave * (std::log2(error) - float(scale_))), 1L, 255L));
  }
  float unpack(std::uint8_t code) const {
    return code == 0 ? 0 : static_cast<float>(std::exp2(scale_ + double(code) / codes_per_octave));
  }

 private:
  static constexpr int codes_per_octave = 8, octaves = 31;
  int scale_;
};

/// The told errors of consecutive leaves of a whole state.
struct ErrorPage {
  PatchId first;  ///< the first of these leaves
  ErrorCoding coding{0};
  std::vector<std::uint8_t> codes;  ///< by leaf, in the order of their ids
};

/// How many errors a page may hold where a page of values holds `values`: they take a fifteenth of the bytes.
constexpr std::size_t errors_per_page(std::size_t values) {
  constexpr std::size_t times = 15;
  return values > ~std::size_t{0} / times ? ~std::size_t{0} : times * values;
}

}  // namespace alvor
