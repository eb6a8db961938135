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

/// A place on a chart, and the normal of its front there.
struct FrontPoint {
  Vec3 at, normal;
};

/// Returns some points of a chart, of at most `most` triangles, off their middles: the middle of a rectangle is on the diagonal
/// that cuts it.
std::vector<FrontPoint> some_points(const PlacedChart& chart, std::size_t most) {
  std::vector<FrontPoint> points;
  const auto& triangles = chart.chart->triangles;
  const std::size_t step = (triangles.size() + most - 1) / most;
  for (std::size_t n = 0; n < triangles.size(); n += step) {
    const Vec3 normal = placed_normal(chart, triangles[n]);
    if (normal == Vec3{}) continue;
    for (const auto& [u, v] : {std::pair(0.2, 0.2), std::pair(0.6, 0.2), std::pair(0.2, 0.6)})
      points.push_back({placed_point(chart, triangles[n], u, v), normal});
  }
  return points;
}

/// Returns the sum of the irradiance, mean over bands, at points of an object's front (`side` 1) or back (-1).
double light_on(std::span<const FrontPoint> points, double side, std::size_t object, const SolvedSurface& surface) {
  double sum = 0;
  for (const auto& [at, normal] : points)
    if (const auto sample = surface.at(object, at, side * normal)) sum += sample->irradiance.mean();
  return sum;
}

/// Returns the leaving share of a chart's front (SolvedSurface::leaving_share) less that of its back, mean over some points.
double leaves_front_more(const PlacedChart& chart, const SolvedSurface& surface) {
  constexpr std::size_t most = 8;
  double sum = 0;
  const auto points = some_points(chart, most);
  for (std::size_t n = 0; n < points.size(); ++n)
    sum += surface.leaving_share(points[n].at, points[n].normal, n) - surface.leaving_share(points[n].at, -points[n].normal, n);
  return points.empty() ? 0 : sum / static_cast<double>(points.size());
}

}  // namespace

ShownSide shown_side(const PlacedChart& chart, const SolvedSurface& surface, BakedSide wanted) {
  if (!chart.may_show_back) return {};
  // All chosen. A side with less than `lit` of the other's light is taken for the inside of a solid, not of a room; a difference
  // of leaving shares up to `clearly` for that of two sides in one room, or outdoors.
  constexpr double lit = 1e-3, clearly = 0.3, much = 0.1;
  constexpr std::size_t most = 64;
  const std::vector<FrontPoint> points = some_points(chart, most);
  const double front = light_on(points, 1, chart.object, surface), back = light_on(points, -1, chart.object, surface);
  bool is_back = back > front;
  if (wanted == BakedSide::inner && std::min(front, back) > lit * std::max(front, back))
    if (const double more = leaves_front_more(chart, surface); std::abs(more) > clearly) is_back = more > 0;
  return {is_back, (is_back ? front : back) > much * (is_back ? back : front)};
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
        float errors = 0, count = 0;
        for (int v = std::max(0, y - 1); v <= std::min(within.high - 1, y + 1); ++v)
          for (int u = std::max(0, x - 1); u <= std::min(within.wide - 1, x + 1); ++u) {
            if (!was_set[cell(u, v)]) continue;
            const RgbF& beside = page.texels[page.index(within.x + u, within.y + v)];
            sum.r += beside.r, sum.g += beside.g, sum.b += beside.b;
            if (!page.errors.empty()) errors += page.errors[page.index(within.x + u, within.y + v)];
            count += 1;
          }
        if (count == 0) continue;
        const std::size_t index = page.index(within.x + x, within.y + y);
        page.texels[index] = {sum.r / count, sum.g / count, sum.b / count};
        if (!page.errors.empty()) page.errors[index] = errors / count;
        page.is_set[index] = true;
        has_changed = true;
      }
    if (!has_changed) return;
  }
}

}  // namespace alvor
