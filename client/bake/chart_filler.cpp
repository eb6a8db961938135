#include "client/bake/texels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace alvor {

namespace {

using Point = FlatPoint;

// Points that are darker than this share of the brightest texel beside them may be covered. Chosen.
constexpr double much_darker = 0.75;
// Share of that brightest texel below which what a covered point sees counts as dark. Chosen.
constexpr double darkness = 0.02;
// Texels without light are looked at up to so many texels from the light, and take it on if they are covered: mip levels mix
// them.
constexpr int reach_of_darkness = 4;

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
        nearest_(static_cast<std::size_t>(place.wide) * static_cast<std::size_t>(place.high)),
        light_(nearest_.size()) {}

  void fill() {
    for (const std::uint32_t t : chart_.chart->triangles) look_at(t);
    for (int y = 0; y < place_.high; ++y)
      for (int x = 0; x < place_.wide; ++x) set(x, y, std::nullopt);
    uncover();
    spread(page_, place_, reach_of_darkness);
  }

 private:
  std::size_t cell(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(place_.wide) + static_cast<std::size_t>(x);
  }
  OnTriangle& at(int x, int y) { return nearest_[cell(x, y)]; }
  Point middle(int x, int y) const { return {place_.x + x + 0.5, place_.y + y + 0.5}; }

  std::array<Point, 3> flat(std::uint32_t t) const {
    std::array<Point, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) corners[c] = texel_of(chart_, place_, padding_, chart_.mesh->triangles[t][c]);
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

  bool is_inside(int x, int y) { return x >= 0 && y >= 0 && x < place_.wide && y < place_.high && at(x, y).distance == 0; }

  /// The points of a surface that a texel stands for.
  struct Footprint {
    std::array<Vec3, 4> points;
    std::size_t count = 0;
    std::uint32_t triangle = 0;
  };

  std::optional<Footprint> footprint(int x, int y) {
    const OnTriangle& on = at(x, y);
    if (std::isinf(on.distance)) return std::nullopt;
    Footprint of{{}, 0, on.triangle};
    const bool is_surrounded = is_inside(x - 1, y) && is_inside(x + 1, y) && is_inside(x, y - 1) && is_inside(x, y + 1);
    if (!is_surrounded) {
      const double inwards = share_inwards(on.triangle);
      of.points[of.count++] =
          placed_point(chart_, on.triangle, std::lerp(on.u, 1.0 / 3, inwards), std::lerp(on.v, 1.0 / 3, inwards));
      return of;
    }
    const auto corners = flat(on.triangle);
    const Point from = middle(x, y);
    for (const double dx : {-0.25, 0.25})
      for (const double dy : {-0.25, 0.25}) {
        const auto [u, v] = affine(corners, {from[0] + dx, from[1] + dy});
        of.points[of.count++] = placed_point(chart_, on.triangle, u, v);
      }
    return of;
  }

  /// Sets a texel to the mean over its points, without the covered ones that are much darker than `bright`, W/m2; so a texel
  /// beside what stands on the surface shows the light there, not half the darkness below it. A texel without points stays unset.
  void set(int x, int y, std::optional<double> bright) {
    const auto of = footprint(x, y);
    if (!of) return;
    const std::size_t index = page_.index(place_.x + x, place_.y + y);
    const Vec3 normal = normal_of(of->triangle);
    Rgb sum, irradiance;
    double count = 0, squared_errors = 0;
    for (std::size_t n = 0; n < of->count; ++n) {
      const auto sample = surface_.at(chart_.object, of->points[n], normal);
      if (!sample) continue;
      if (bright && sample->irradiance.mean() <= much_darker * *bright &&
          surface_.is_covered(of->points[n], normal, darkness * *bright))
        continue;
      sum += value_(*sample), irradiance += sample->irradiance, squared_errors += sample->error * sample->error, count += 1;
    }
    page_.is_set[index] = count > 0;
    page_.texels[index] = count > 0 ? narrow(sum * (1 / count)) : RgbF{};
    if (!page_.errors.empty()) page_.errors[index] = count > 0 ? static_cast<float>(std::sqrt(squared_errors / count)) : 0;
    light_[cell(x, y)] = count > 0 ? irradiance.mean() / count : 0;
  }

  /// Sets the texels again that are darker than what is near them, if it is because they are covered.
  void uncover() {
    const std::vector<double> light = light_;
    for (int y = 0; y < place_.high; ++y)
      for (int x = 0; x < place_.wide; ++x) {
        const double here = light[cell(x, y)];
        double bright = 0;
        const int reach = here > 0 ? 1 : reach_of_darkness;
        for (int v = std::max(0, y - reach); v <= std::min(place_.high - 1, y + reach); ++v)
          for (int u = std::max(0, x - reach); u <= std::min(place_.wide - 1, x + reach); ++u)
            bright = std::max(bright, light[cell(u, v)]);
        if (here < much_darker * bright) set(x, y, bright);
      }
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
  std::vector<double> light_;        // irradiance by texel of the rectangle, W/m2
};

}  // namespace

void fill(LightPage& page, const PlacedChart& chart, const ChartPlace& place, int padding, bool shows_back,
          const SolvedSurface& surface, const TexelValue& value) {
  Filler(page, chart, place, padding, shows_back, surface, value).fill();
}

}  // namespace alvor
