#include "client/picture/text.h"

#include <stb/stb_easy_font.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace alvor {
namespace {

/// A corner as stb_easy_font writes it; four make a box.
struct FontCorner {
  float x, y, z;
  std::uint8_t colour[4];
};

std::vector<FontCorner> boxes_of(std::string text) {
  constexpr std::size_t most_per_letter = 24 * 4;
  std::vector<FontCorner> corners(text.size() * most_per_letter);
  const int size = static_cast<int>(corners.size() * sizeof(FontCorner));
  const int boxes = stb_easy_font_print(0, 0, text.data(), nullptr, corners.data(), size);
  corners.resize(4 * static_cast<std::size_t>(boxes));
  return corners;
}

[[maybe_unused]] bool printable(const std::string& text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace

void fill(Image& image, const PixelBox& box, const Colour& colour) {
  const int right = std::min(box.left + box.width, image.width), bottom = std::min(box.top + box.height, image.height);
  for (int y = std::max(box.top, 0); y < bottom; ++y)
    for (int x = std::max(box.left, 0); x < right; ++x)
      std::ranges::copy(colour, image.rgb.begin() + 3L * (y * long{image.width} + x));
}

int text_width(const std::string& text) {
  assert(printable(text));
  float right = 0;
  for (const FontCorner& corner : boxes_of(text)) right = std::max(right, corner.x);
  return static_cast<int>(right);
}

void draw_text(Image& image, int left, int top, const std::string& text, int scale, const Colour& colour) {
  assert(printable(text) && scale >= 1);
  const auto pixels = [scale](float dots) { return scale * static_cast<int>(dots); };
  const std::vector<FontCorner> corners = boxes_of(text);
  for (std::size_t i = 0; i < corners.size(); i += 4) {
    const FontCorner &first = corners[i], &last = corners[i + 2];
    fill(image, {left + pixels(first.x), top + pixels(first.y), pixels(last.x - first.x), pixels(last.y - first.y)}, colour);
  }
}

}  // namespace alvor
