#pragma once
// Words and numbers in a picture.

#include "client/picture/png_file.h"

#include <array>
#include <cstdint>
#include <string>

namespace alvor {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB

/// A place in a picture, or a size, in pixels; right and down.
struct PixelBox {
  int left = 0, top = 0;
  int width = 0, height = 0;
};

/// Whatever lies outside the picture is cut off.
void fill(Image& image, const PixelBox& box, const Colour& colour);

/// Letters are `letter_height` high at scale 1, from the top of a capital to the line they stand on.
constexpr int letter_height = 7;

/// Pixels from the first letter's left edge to the last one's right, at scale 1. Requires: printable ASCII.
int text_width(const std::string& text);

/// One line, its first letter's top left corner at (left, top); each dot of the font is a square of `scale` pixels. Requires:
/// printable ASCII, scale >= 1.
void draw_text(Image& image, int left, int top, const std::string& text, int scale, const Colour& colour);

}  // namespace alvor
