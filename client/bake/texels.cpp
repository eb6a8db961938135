#include "client/bake/texels.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace alvor {

namespace {

using Point = FlatPoint;

/// A place on a triangle: (1-u-v) a + u b + v c.
struct OnTriangle {
  double u = 0, v = 0;
  double distance = std::numeric_limits<double>::infinity();  // from the point asked for, texels
  std::uint32_t triangle = 0;
};

double share_along(const Point& a, const Point& b, const Point& p) {
  const double x = b[0] - a[0], y = b[1] - a[1], squared = x * x + y * y;
  return squared > 0 ? std::clamp(((p[0] - a[0]) * x + (p[1] - a[1]) * y) / squared, 0.0, 1.0) : 0;
}

/// Returns the point of a triangle that is nearest to `p`.
OnTriangle nearest_on(const std::array<Point, 3>& corners, const Point& p) {
  const auto& [a, b, c] = corners;
  const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  OnTriangle found;
  if (twice != 0) {
    found.u = ((p[0] - a[0]) * (c[1] - a[1]) - (p[1] - a[1]) * (c[0] - a[0])) / twice;
    found.v = ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / twice;
    if (found.u >= 0 && found.v >= 0 && found.u + found.v <= 1) {
      found.distance = 0;
      return found;
    }
  }
  const auto try_edge = [&](const Point& from, const Point& to, auto place) {
    const double share = share_along(from, to, p);
    const double distance = std::hypot(from[0] + share * (to[0] - from[0]) - p[0], from[1] + share * (to[1] - from[1]) - p[1]);
    if (distance < found.distance) found = place(share), found.distance = distance;
  };
  try_edge(a, b, [](double s) { return OnTriangle{s, 0}; });
  try_edge(b, c, [](double s) { return OnTriangle{1 - s, s}; });
  try_edge(c, a, [](double s) { return OnTriangle{0, 1 - s}; });
  return found;
}

/// Fills the rectangle of one chart.
class Filler {
 public:
  Filler(LightPage& page, const PlacedChart& chart, const ChartPlace& place, int padding, bool shows_back,
         const SolvedSurface& surface, const TexelValue& value)
      : page_(page),
        chart_(chart),
        place_(place),
        padding_(padding),
        side_(shows_back ? -1 : 1),
        surface_(surface),
        value_(value),
        nearest_(static_cast<std::size_t>(place.wide) * static_cast<std::size_t>(place.high)) {}

  void fill() {
    for (const std::uint32_t t : chart_.chart->triangles) look_at(t);
    for (int y = 0; y < place_.high; ++y)
      for (int x = 0; x < place_.wide; ++x) set(x, y);
  }

 private:
  OnTriangle& at(int x, int y) {
    return nearest_[static_cast<std::size_t>(y) * static_cast<std::size_t>(place_.wide) + static_cast<std::size_t>(x)];
  }
  Point middle(int x, int y) const { return {place_.x + x + 0.5, place_.y + y + 0.5}; }

  std::array<Point, 3> flat(std::uint32_t t) const {
    std::array<Point, 3> corners;
    for (std::size_t c = 0; c < 3; ++c)
      corners[c] = texel_of(chart_, place_, padding_, chart_.mesh->triangles[t][c]);
    return corners;
  }

  /// Offers a triangle to the texels in and around it.
  void look_at(std::uint32_t t) {
    const auto corners = flat(t);
    const auto range = [&](std::size_t k, int begin, int most) {
      const auto [from, to] = std::minmax({corners[0][k], corners[1][k], corners[2][k]});
      return std::pair(std::max(0, static_cast<int>(std::floor(from)) - begin - padding_ - 1),
                       std::min(most - 1, static_cast<int>(std::floor(to)) - begin + padding_ + 1));
    };
    const auto [x0, x1] = range(0, place_.x, place_.wide);
    const auto [y0, y1] = range(1, place_.y, place_.high);
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        OnTriangle& known = at(x, y);
        if (known.distance == 0) continue;
        OnTriangle found = nearest_on(corners, middle(x, y));
        found.triangle = t;
        if (found.distance < known.distance) known = found;
      }
  }

  bool is_inside(int x, int y) {
    return x >= 0 && y >= 0 && x < place_.wide && y < place_.high && at(x, y).distance == 0;
  }

  void set(int x, int y) {
    const OnTriangle& on = at(x, y);
    if (std::isinf(on.distance)) return;
    const bool is_surrounded = is_inside(x - 1, y) && is_inside(x + 1, y) && is_inside(x, y - 1) && is_inside(x, y + 1);
    Rgb sum;
    double count = 0;
    const auto add = [&](double u, double v) {
      if (const auto sample = surface_.at(chart_.object, placed_point(chart_, on.triangle, u, v), normal_of(on.triangle)))
        sum += value_(*sample), count += 1;
    };
    if (is_surrounded) {
      const auto corners = flat(on.triangle);
      const Point from = middle(x, y);
      for (const double dx : {-0.25, 0.25})
        for (const double dy : {-0.25, 0.25}) {
          const auto [u, v] = affine(corners, {from[0] + dx, from[1] + dy});
          add(u, v);
        }
    } else {
      const double inwards = share_inwards(on.triangle);
      add(std::lerp(on.u, 1.0 / 3, inwards), std::lerp(on.v, 1.0 / 3, inwards));
    }
    if (count == 0) return;
    const std::size_t index = page_.index(place_.x + x, place_.y + y);
    page_.texels[index] = narrow(sum * (1 / count));
    page_.is_set[index] = true;
  }

  /// Returns the share of the way to a triangle's middle by which points on its edge are moved, about a fiftieth of a texel: on
  /// the edge itself rounding would decide whether the next face is looked at.
  double share_inwards(std::uint32_t t) const {
    constexpr double texels = 0.02, most = 0.1;
    const auto [a, b, c] = flat(t);
    double size = 0;
    for (std::size_t k = 0; k < 2; ++k) size = std::max(size, std::max({a[k], b[k], c[k]}) - std::min({a[k], b[k], c[k]}));
    return std::min(most, texels / size);
  }

  static Point affine(const std::array<Point, 3>& corners, const Point& p) {
    const auto& [a, b, c] = corners;
    const double twice = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    return {((p[0] - a[0]) * (c[1] - a[1]) - (p[1] - a[1]) * (c[0] - a[0])) / twice,
            ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])) / twice};
  }

  Vec3 normal_of(std::uint32_t t) const { return side_ * placed_normal(chart_, t); }

  LightPage& page_;
  const PlacedChart& chart_;
  const ChartPlace& place_;
  int padding_;
  double side_;
  const SolvedSurface& surface_;
  const TexelValue& value_;
  std::vector<OnTriangle> nearest_;  // by texel of the rectangle
};

}  // namespace

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
  const auto along = [&](double part, int begin, int texels) { return begin + padding + 0.5 + part * (texels - 2 * padding - 1); };
  // Rows run downwards: v is turned, so that charts are not mirrored.
  return {along(share(u, chart.chart->wide), place.x, place.wide),
          along(1 - share(v, chart.chart->high), place.y, place.high)};
}

ShownSide brighter_side(const PlacedChart& chart, const SolvedSurface& surface) {
  if (!chart.may_show_back) return {};
  constexpr std::size_t most = 64;
  double front = 0, back = 0;
  const auto& triangles = chart.chart->triangles;
  const std::size_t step = std::max<std::size_t>(1, triangles.size() / most);
  for (std::size_t n = 0; n < triangles.size(); n += step) {
    const Vec3 normal = placed_normal(chart, triangles[n]);
    // Off the middle: the middle of a rectangle is on the diagonal that cuts it.
    for (const auto& [u, v] : {std::pair(0.2, 0.2), std::pair(0.6, 0.2), std::pair(0.2, 0.6)}) {
      const Vec3 at = placed_point(chart, triangles[n], u, v);
      if (const auto sample = surface.at(chart.object, at, normal)) front += sample->irradiance.mean();
      if (const auto sample = surface.at(chart.object, at, -1.0 * normal)) back += sample->irradiance.mean();
    }
  }
  constexpr double much = 0.1;
  return {back > front, std::min(front, back) > much * std::max(front, back)};
}

void fill(LightPage& page, const PlacedChart& chart, const ChartPlace& place, int padding, bool shows_back,
          const SolvedSurface& surface, const TexelValue& value) {
  Filler(page, chart, place, padding, shows_back, surface, value).fill();
}

void spread(LightPage& page, int times) {
  for (int n = 0; n < times; ++n) {
    const std::vector<std::uint8_t> was_set = page.is_set;
    bool is_full = true;
    for (int y = 0; y < page.size; ++y)
      for (int x = 0; x < page.size; ++x) {
        const std::size_t index = page.index(x, y);
        if (was_set[index]) continue;
        RgbF sum;
        float count = 0;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            if (x + dx < 0 || y + dy < 0 || x + dx >= page.size || y + dy >= page.size) continue;
            const std::size_t beside = page.index(x + dx, y + dy);
            if (!was_set[beside]) continue;
            sum.r += page.texels[beside].r, sum.g += page.texels[beside].g, sum.b += page.texels[beside].b;
            count += 1;
          }
        is_full = is_full && count > 0;
        if (count == 0) continue;
        page.texels[index] = {sum.r / count, sum.g / count, sum.b / count};
        page.is_set[index] = true;
      }
    if (is_full) return;
  }
}

}  // namespace alvor
