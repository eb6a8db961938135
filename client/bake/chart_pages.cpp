#include "client/bake/chart_pages.h"

#include <algorithm>
#include <cmath>

#define STB_RECT_PACK_IMPLEMENTATION
#define STBRP_STATIC
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

namespace alvor {

namespace {

// Rectangles begin at multiples of so many texels, so that texels of two smaller mip levels belong to one chart.
constexpr int cell = 4;

/// Returns the texels of a side: the chart is stretched to a whole number of steps between texels, and has one at each end.
double texels_of(double metres, double texels_per_metre) { return std::max(1.0, std::round(metres * texels_per_metre)) + 1; }

/// Packs as many of the rectangles as fit one page; returns the others.
std::vector<stbrp_rect> pack_page(std::vector<stbrp_rect> rectangles, int page, ChartPages& pages) {
  stbrp_context context;
  const int cells = pages.size / cell;
  std::vector<stbrp_node> nodes(static_cast<std::size_t>(cells));
  stbrp_init_target(&context, cells, cells, nodes.data(), cells);
  stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size()));
  std::vector<stbrp_rect> left;
  for (const stbrp_rect& rectangle : rectangles) {
    if (!rectangle.was_packed) {
      left.push_back(rectangle);
      continue;
    }
    ChartPlace& place = pages.places[static_cast<std::size_t>(rectangle.id)];
    place.page = page, place.x = cell * int(rectangle.x), place.y = cell * int(rectangle.y);
  }
  return left;
}

std::optional<ChartPages> placed(std::span<const ChartSize> charts, const ChartPageOptions& options, double texels_per_metre,
                                 int most_pages) {
  ChartPages pages{options.size, options.padding, 0, texels_per_metre, std::vector<ChartPlace>(charts.size())};
  std::vector<stbrp_rect> left;
  double texels = 0;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    const double wide = texels_of(charts[c].wide, texels_per_metre) + 2 * options.padding,
                 high = texels_of(charts[c].high, texels_per_metre) + 2 * options.padding;
    texels += wide * high;
    const double largest = options.size / cell * cell;
    if (wide > largest || high > largest || texels > double(options.size) * options.size * most_pages) return std::nullopt;
    stbrp_rect rectangle{};
    ChartPlace& place = pages.places[c];
    place.wide = static_cast<int>(wide), place.high = static_cast<int>(high);
    rectangle.id = static_cast<int>(c), rectangle.w = (place.wide + cell - 1) / cell, rectangle.h = (place.high + cell - 1) / cell;
    left.push_back(rectangle);
  }
  while (!left.empty()) {
    if (pages.count == most_pages) return std::nullopt;
    left = pack_page(std::move(left), pages.count++, pages);
  }
  return pages;
}

}  // namespace

std::optional<ChartPages> place_charts(std::span<const ChartSize> charts, const ChartPageOptions& options) {
  if (options.texels_per_metre) return placed(charts, options, *options.texels_per_metre, options.most_pages);
  double area = 0, longest = 0;
  for (const ChartSize& chart : charts) area += chart.wide * chart.high, longest = std::max({longest, chart.wide, chart.high});
  if (!(area > 0)) return placed(charts, options, 1, 1);
  // The density that would fill the page is halved until all charts fit, then raised again, within a fiftieth of the best.
  constexpr int halvings = 30, steps = 5;
  double low = options.size / std::max(std::sqrt(area), longest);
  std::optional<ChartPages> pages;
  for (int n = 0; n < halvings && !(pages = placed(charts, options, low, 1)); ++n) low /= 2;
  double high = 2 * low;
  for (int n = 0; n < steps && pages; ++n) {
    const double middle = std::sqrt(low * high);
    if (auto denser = placed(charts, options, middle, 1)) pages = std::move(denser), low = middle;
    else high = middle;
  }
  return pages;
}

}  // namespace alvor
