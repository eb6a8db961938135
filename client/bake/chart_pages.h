#pragma once
// Places charts on the pages of a texture.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// A chart's size on a surface, metres.
struct ChartSize {
  double wide = 0, high = 0;
};

/// The rectangle of texels of a chart. The chart lies on its inner part: from the middle of texel x + padding to the middle of
/// texel x + wide - padding - 1, and likewise in y, so that its edges are read from texels of its own.
struct ChartPlace {
  int page = 0, x = 0, y = 0, wide = 0, high = 0;  ///< with the padding on all sides
};

struct ChartPages {
  int size = 0;     ///< columns and rows of each page
  int padding = 0;  ///< texels
  int count = 0;    ///< of pages
  double texels_per_metre = 0;
  std::vector<ChartPlace> places;  ///< by chart
};

struct ChartPageOptions {
  int size = 1024;
  int padding = 4;  ///< four is enough for two smaller mip levels
  std::optional<double> texels_per_metre;  ///< as many as fit one page if not given
  int most_pages = 64;
};

/// Places all charts. Returns nothing if they do not fit. Requires: sizes are finite and not negative.
std::optional<ChartPages> place_charts(std::span<const ChartSize> charts, const ChartPageOptions& options);

}  // namespace alvor
