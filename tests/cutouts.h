#pragma once
// Textures with holes, for tests.

#include "tests/textures.h"

namespace alvor::test {

/// Returns an image of one grey with the opacities that are given, row by row.
inline ColourImage cut_out(std::uint32_t columns, std::uint32_t rows, std::uint8_t value,
                           const std::vector<std::uint8_t>& opacities) {
  ColourImage image{columns, rows, {}, true};
  for (const std::uint8_t opacity : opacities) image.texels.insert(image.texels.end(), {value, value, value, opacity});
  return image;
}

/// Returns an image of squares that are there and cut out in turn.
inline ColourImage lattice(std::uint32_t squares, std::uint8_t value) {
  std::vector<std::uint8_t> opacities;
  for (std::uint32_t n = 0; n < squares * squares; ++n) opacities.push_back((n / squares + n % squares) % 2 == 0 ? 255 : 0);
  return cut_out(squares, squares, value, opacities);
}

/// Returns the image with random opacities, some of them 0 and 255.
inline ColourImage with_holes(const ColourImage& opaque, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  ColourImage image{opaque.columns, opaque.rows, {}, true};
  for (std::size_t i = 0; i < opaque.texel_count(); ++i) {
    image.texels.insert(image.texels.end(), &opaque.texels[3 * i], &opaque.texels[3 * i] + 3);
    image.texels.push_back(i % 3 == 0 ? 0 : i % 3 == 1 ? 255 : static_cast<std::uint8_t>(random() % 256));
  }
  return image;
}

}  // namespace alvor::test
