#pragma once
// Draws text and boxes in a picture.

#include "client/picture/png_file.h"

#include <array>
#include <cstdint>
#include <string>

namespace alvor {

using Colour = std::array<std::uint8_t, 3>;  ///< sRGB

/// A rectangle in a picture, in pixels; left and top are counted from the upper left corner.
struct PixelBox {
  int left = 0, top = 0;
  int width = 0, height = 0;
};

/// Fills a box; the part outside the picture is cut off.
void fill(Image& image, const PixelBox& box, const Colour& colour);

/// Height of letters at scale 1, from the top of a capital to the baseline, pixels.
constexpr int letter_height = 7;

/// Returns the width of a text at scale 1, pixels. Requires: printable ASCII.
int text_width(const std::string& text);

/// Draws one line of text with its top left corner at (left, top). Each dot of the font is a square of `scale` pixels. Requires:
/// printable ASCII, scale >= 1.
void draw_text(Image& image, int left, int top, const std::string& text, int scale, const Colour& colour);

}  // namespace alvor
