#pragma once
// Means of textures over polygons, exactly.

#include "meshing/texture.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// A point on an image that goes on beyond its edges, in texels from the upper left corner.
struct TexelPoint {
  double x = 0, y = 0;
};

/// Sums along the rows of an image, by which means over polygons take time in proportion to their outlines and not to their
/// areas. A texel counts as constant; its reflectance is rounded to 2^-19. Immutable; safe from any thread. Borrows the image.
class TextureMean {
 public:
  /// Returns how much memory the sums of an image take, bytes: 12 or 16 a texel.
  static std::size_t bytes_for(const ColourImage& image) { return sizeof(std::uint32_t) * image.byte_count(); }
  /// `of_texel` is as for mean_surface(). Requires: !fault_in(image).
  explicit TextureMean(const ColourImage& image, double (*of_texel)(std::uint8_t) = reflectance_of_texel);

  /// Returns the mean over a polygon (by Green's theorem: the integral of a texel row's running sum along the
  /// outline); that of the whole image if its outline crosses more than 65 536 texels; the texel of its first corner if it has no
  /// area. Requires: three corners or more, of which no coordinate is above 1e9.
  MeanSurface over(std::span<const TexelPoint> polygon, Wrap across, Wrap down) const;

 private:
  /// Sums of four values of texels: reflectance times opacity in three bands, and opacity.
  using Sums = std::array<double, 4>;
  /// The running sum along a row at the left side of a texel, and the texel's value: the sum is linear within the texel.
  struct Column {
    Sums before, value;
  };
  std::array<std::uint32_t, 4> value_of(std::uint32_t column, std::uint32_t row) const;
  std::array<std::uint32_t, 4> sum_before(std::uint32_t column, std::uint32_t row) const;
  Sums total_of(std::uint32_t row) const;
  Column column(std::int64_t index, std::uint32_t row, Wrap wrap) const;
  void add_edge(TexelPoint from, TexelPoint to, Wrap across, Wrap down, Sums& integral) const;

  const ColourImage& image_;
  const MeanSurface mean_;                        // of the whole image
  const std::size_t bands_;                       // 3, or 4 with opacity
  std::array<std::uint32_t, 256> value_of_byte_;  // reflectance in units of 2^-19
  std::vector<std::uint32_t> sum_before_;         // by texel and band: sum of the values before it in its row
};

}  // namespace alvor
