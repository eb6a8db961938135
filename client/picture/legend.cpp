#include "client/picture/legend.h"

#include "client/picture/round_number.h"
#include "client/picture/text.h"
#include "client/picture/tone_map.h"

#include <algorithm>
#include <cmath>

namespace alvor {
namespace {

// Lengths in dots of the font.
constexpr int usual_width = 66;
constexpr int margin = 6, bar_width = 10, mark_length = 3, gap = 3;
constexpr int line_height = 11, title_gap = 5, least_height = 90;
constexpr double bar_share = 0.76;  ///< height of the bar as a fraction of the picture's

int pixels_per_dot(int picture_height) { return std::max(1, static_cast<int>(std::lround(picture_height / 384.0))); }

/// Positions of the legend's parts, pixels.
struct Layout {
  int dot = 1;
  PixelBox bar;
  int panel_left = 0, title_top = 0, text_left = 0;
};

int width_of(const std::vector<LegendLabel>& labels) {
  int widest = 0;
  for (const LegendLabel& label : labels) widest = std::max(widest, text_width(label.text));
  return 2 * margin + bar_width + mark_length + gap + widest;
}

Layout layout_of(const Image& image, const Legend& legend, const std::vector<LegendLabel>& labels) {
  Layout at;
  at.dot = pixels_per_dot(image.height);
  at.panel_left = image.width - at.dot * std::max(usual_width, width_of(labels));
  const int title_height = at.dot * (line_height * static_cast<int>(legend.title.size()) + title_gap);
  const int bar_height = static_cast<int>(bar_share * image.height);
  at.title_top = (image.height - title_height - bar_height) / 2;
  at.bar = {at.panel_left + at.dot * margin, at.title_top + title_height, at.dot * bar_width, bar_height};
  at.text_left = at.bar.left + at.bar.width + at.dot * (mark_length + gap);
  return at;
}

Colour bytes_of(const Rgb& colour) { return {srgb_byte(colour.r), srgb_byte(colour.g), srgb_byte(colour.b)}; }

void draw_bar(Image& image, const PixelBox& bar, const Legend& legend) {
  for (int row = 0; row < bar.height; ++row)
    fill(image, {bar.left, bar.top + row, bar.width, 1}, bytes_of(legend.colours(1 - (row + 0.5) / bar.height)));
}

void draw_label(Image& image, const Layout& at, const LegendLabel& label, const Colour& ink) {
  const int middle = at.bar.top + static_cast<int>(std::lround((1 - label.position) * (at.bar.height - at.dot))) + at.dot / 2;
  fill(image, {at.bar.left + at.bar.width, middle - at.dot / 2, at.dot * mark_length, at.dot}, ink);
  draw_text(image, at.text_left, middle - at.dot * letter_height / 2, label.text, at.dot, ink);
}

void draw(Image& image, const Legend& legend) {
  const double line = line_height * pixels_per_dot(image.height) / (bar_share * image.height);
  const std::vector<LegendLabel> labels = labels_of(legend, std::min(line, 1.0));
  const Layout at = layout_of(image, legend, labels);
  fill(image, {at.panel_left, 0, image.width - at.panel_left, image.height}, legend.paper);
  for (std::size_t i = 0; i < legend.title.size(); ++i)
    draw_text(image, at.bar.left, at.title_top + at.dot * line_height * static_cast<int>(i), legend.title[i], at.dot, legend.ink);
  draw_bar(image, at.bar, legend);
  for (const LegendLabel& label : labels) draw_label(image, at, label, legend.ink);
}

}  // namespace

std::vector<LegendLabel> labels_of(const Legend& legend, double least_distance) {
  constexpr int most_ticks = 10;
  const int room = std::clamp(static_cast<int>(0.6 / least_distance), 2, most_ticks);
  std::vector<LegendLabel> labels{{0, (legend.values_below ? "<= " : "") + short_text(legend.scale.low)}};
  for (const double tick : ticks(legend.scale, room)) {
    const double position = legend.scale.position(tick);
    if (position - labels.back().position >= least_distance && 1 - position >= least_distance)
      labels.push_back({position, short_text(tick)});
  }
  labels.push_back({1, (legend.values_above ? ">= " : "") + short_text(legend.scale.high)});
  return labels;
}

int legend_width(int picture_height) { return usual_width * pixels_per_dot(picture_height); }

bool legend_fits(PictureSize picture) {
  constexpr int view_to_legend = 2;
  const int width = legend_width(picture.height);
  return picture.height >= least_height * pixels_per_dot(picture.height) && picture.width >= (1 + view_to_legend) * width;
}

Image with_legend(const Image& view, const Legend& legend) {
  Image image{view.width + legend_width(view.height), view.height, {}};
  const auto view_row = 3 * static_cast<std::ptrdiff_t>(view.width), row = 3 * static_cast<std::ptrdiff_t>(image.width);
  image.rgb.resize(static_cast<std::size_t>(row * image.height));
  for (int y = 0; y < view.height; ++y) std::copy_n(view.rgb.begin() + y * view_row, view_row, image.rgb.begin() + y * row);
  draw(image, legend);
  return image;
}

}  // namespace alvor
