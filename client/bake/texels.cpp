#include "client/bake/texels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alvor {

std::array<Vec3, 3> placed_corners(const PlacedChart& chart, std::uint32_t t) {
  std::array<Vec3, 3> corners;
  for (std::size_t c = 0; c < 3; ++c)
    corners[c] = chart.placement.point(chart.positions[chart.mesh->source[chart.mesh->triangles[t][c]]]);
  return corners;
}

Vec3 placed_point(const PlacedChart& chart, std::uint32_t t, double u, double v) {
  const auto [a, b, c] = placed_corners(chart, t);
  return (1 - u - v) * a + u * b + v * c;
}

Vec3 placed_normal(const PlacedChart& chart, std::uint32_t t) {
  const auto [a, b, c] = placed_corners(chart, t);
  const Vec3 normal = cross(b - a, c - a);
  const double size = length(normal);
  if (!(size > 0)) return {};
  return (chart.placement.mirrors() ? -1 / size : 1 / size) * normal;
}

ChartSize size_of(const PlacedChart& placed) {
  const Chart& chart = *placed.chart;
  if (!(chart.u == Vec3{}))
    return {chart.wide * length(placed.placement.direction(chart.u)), chart.high * length(placed.placement.direction(chart.v))};
  PlacedChart unplaced = placed;
  unplaced.placement = {};
  double area = 0, own = 0;
  for (const std::uint32_t t : chart.triangles) {
    const auto [a, b, c] = placed_corners(placed, t);
    const auto [x, y, z] = placed_corners(unplaced, t);
    area += length(cross(b - a, c - a)), own += length(cross(y - x, z - x));
  }
  const double scale = std::sqrt(area / own);
  return {scale * chart.wide, scale * chart.high};
}

std::array<double, 2> texel_of(const PlacedChart& chart, const ChartPlace& place, int padding, std::uint32_t vertex) {
  const auto [u, v] = chart.mesh->flat[vertex];
  const auto share = [](double value, double side) { return side > 0 ? std::clamp(value / side, 0.0, 1.0) : 0.5; };
  const auto along = [&](double part, int begin, int texels) {
    return begin + padding + 0.5 + part * (texels - 2 * padding - 1);
  };
  // Rows run downwards: v is turned, so that charts are not mirrored.
  return {along(share(u, chart.chart->wide), place.x, place.wide), along(1 - share(v, chart.chart->high), place.y, place.high)};
}

namespace {

/// What is known of a side of a chart: sums over some of its points.
struct SideSums {
  double light = 0, leaving = 0;  ///< irradiance, mean over bands; SolvedSurface::leaving_share()

  void add(const PlacedChart& chart, const SolvedSurface& surface, const Vec3& at, const Vec3& normal, bool looks_around) {
    if (const auto sample = surface.at(chart.object, at, normal)) light += sample->irradiance.mean();
    if (looks_around) leaving += surface.leaving_share(at, normal);
  }
};

}  // namespace

ShownSide shown_side(const PlacedChart& chart, const SolvedSurface& surface, BakedSide wanted) {
  if (!chart.may_show_back) return {};
  constexpr std::size_t most = 64;
  const bool looks_around = wanted == BakedSide::inner;
  SideSums front, back;
  double points = 0;
  const auto& triangles = chart.chart->triangles;
  const std::size_t step = std::max<std::size_t>(1, triangles.size() / most);
  for (std::size_t n = 0; n < triangles.size(); n += step) {
    const Vec3 normal = placed_normal(chart, triangles[n]);
    // Off the middle: the middle of a rectangle is on the diagonal that cuts it.
    for (const auto& [u, v] : {std::pair(0.2, 0.2), std::pair(0.6, 0.2), std::pair(0.2, 0.6)}) {
      const Vec3 at = placed_point(chart, triangles[n], u, v);
      front.add(chart, surface, at, normal, looks_around);
      back.add(chart, surface, at, -1.0 * normal, looks_around);
      points += 1;
    }
  }
  // The top of a table outdoors and its lower side differ by less: what the lower side sees looks at the sky itself.
  constexpr double clearly = 0.3, much = 0.1;
  const double difference = front.leaving - back.leaving;
  const bool is_back = std::abs(difference) > clearly * points ? difference > 0 : back.light > front.light;
  return {is_back, (is_back ? front.light : back.light) > much * (is_back ? back.light : front.light)};
}

void spread(LightPage& page, const ChartPlace& within, int times) {
  const auto cell = [&](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(within.wide) + static_cast<std::size_t>(x);
  };
  std::vector<std::uint8_t> was_set(static_cast<std::size_t>(within.wide) * static_cast<std::size_t>(within.high));
  for (int n = 0; n < times; ++n) {
    for (int y = 0; y < within.high; ++y)
      for (int x = 0; x < within.wide; ++x) was_set[cell(x, y)] = page.is_set[page.index(within.x + x, within.y + y)];
    bool has_changed = false;
    for (int y = 0; y < within.high; ++y)
      for (int x = 0; x < within.wide; ++x) {
        if (was_set[cell(x, y)]) continue;
        RgbF sum;
        float count = 0;
        for (int v = std::max(0, y - 1); v <= std::min(within.high - 1, y + 1); ++v)
          for (int u = std::max(0, x - 1); u <= std::min(within.wide - 1, x + 1); ++u) {
            if (!was_set[cell(u, v)]) continue;
            const RgbF& beside = page.texels[page.index(within.x + u, within.y + v)];
            sum.r += beside.r, sum.g += beside.g, sum.b += beside.b;
            count += 1;
          }
        if (count == 0) continue;
        const std::size_t index = page.index(within.x + x, within.y + y);
        page.texels[index] = {sum.r / count, sum.g / count, sum.b / count};
        page.is_set[index] = true;
        has_changed = true;
      }
    if (!has_changed) return;
  }
}

}  // namespace alvor
