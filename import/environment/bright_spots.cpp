#include "import/environment/bright_spots.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace alvor {

namespace {

using std::numbers::pi;

constexpr std::size_t most_spots = 4;
// Bright parts that are looked at: those that are too large or bring too little are left, and the next one is tried.
constexpr int most_tries = 32;
constexpr double least_contrast = 20, least_share = 0.01;
// A pixel belongs to a spot if it has this share of the spot's greatest radiance: clouds before the sun and its corona do not.
constexpr float edge_share = 0.05f;
constexpr double radius = 3 * pi / 180;

class SpotFinder {
 public:
  explicit SpotFinder(EnvironmentMap& map) : map_(map), is_tried_(map.pixels.size()), total_(map.total().sum()) {}

  std::vector<BrightSpot> take() {
    std::vector<BrightSpot> spots;
    for (int tries = 0; tries < most_tries && spots.size() < most_spots; ++tries) {
      const std::size_t peak = brightest();
      if (!(double{map_.pixels[peak].sum()} > least_contrast * total_ / (4 * pi))) break;
      if (auto spot = take_at(peak)) spots.push_back(*spot);
    }
    return spots;
  }

 private:
  std::size_t brightest() const {
    std::size_t best = 0;
    float most = -1;
    for (std::size_t n = 0; n < map_.pixels.size(); ++n)
      if (!is_tried_[n] && map_.pixels[n].sum() > most) best = n, most = map_.pixels[n].sum();
    return most < 0 ? 0 : best;
  }
  Vec3 middle_of(std::size_t pixel) const {
    return map_.grid.direction_at(double(pixel % map_.grid.columns) + 0.5, double(pixel / map_.grid.columns) + 0.5);
  }
  /// Calls visit(n) for each neighbour of a pixel; those beyond the poles are left out.
  template <class Visit>
  void for_neighbours(std::size_t pixel, Visit&& visit) const {
    const std::size_t columns = map_.grid.columns, row = pixel / columns, column = pixel % columns;
    visit(row * columns + (column + 1) % columns);
    visit(row * columns + (column + columns - 1) % columns);
    if (row > 0) visit(pixel - columns);
    if (row + 1 < map_.grid.rows) visit(pixel + columns);
  }

  /// The pixels of a bright part and those around it.
  struct Part {
    std::vector<std::size_t> inside, around;
    bool is_small = true;
  };
  Part part_at(std::size_t peak) {
    const float edge = edge_share * map_.pixels[peak].sum();
    const double nearest = std::cos(radius);
    Part part{{peak}, {}};
    std::vector<bool> is_seen(map_.pixels.size());
    is_seen[peak] = is_tried_[peak] = true;
    for (std::size_t n = 0; n < part.inside.size(); ++n)
      for_neighbours(part.inside[n], [&](std::size_t next) {
        if (is_seen[next]) return;
        is_seen[next] = true;
        const bool is_inside = map_.pixels[next].sum() >= edge;
        (is_inside ? part.inside : part.around).push_back(next);
        if (!is_inside) return;
        is_tried_[next] = true;
        part.is_small &= dot(middle_of(next), middle_of(peak)) >= nearest;
      });
    return part;
  }

  double solid_angle(std::size_t pixel) const {
    return map_.grid.solid_angle(static_cast<std::uint32_t>(pixel / map_.grid.columns));
  }
  Vec3 direction_sum(std::size_t pixel) const {
    const std::size_t columns = map_.grid.columns;
    return map_.grid.direction_sum(static_cast<std::uint32_t>(pixel / columns), static_cast<std::uint32_t>(pixel % columns));
  }

  std::optional<BrightSpot> take_at(std::size_t peak) {
    const Part part = part_at(peak);
    if (!part.is_small || part.around.empty()) return std::nullopt;
    Rgb surroundings;
    for (const std::size_t pixel : part.around) surroundings += widen(map_.pixels[pixel]);
    surroundings *= 1.0 / static_cast<double>(part.around.size());
    // Light of the spot above that of its surroundings: times direction for each band, its sum, and the sum of its squares.
    Vec3 red, green, blue;
    double sum = 0, squares = 0;
    for (const std::size_t pixel : part.inside) {
      const Rgb more = widen(map_.pixels[pixel]) - surroundings;
      const Vec3 direction = direction_sum(pixel);
      red += more.r * direction, green += more.g * direction, blue += more.b * direction;
      sum += more.sum() * solid_angle(pixel), squares += more.sum() * more.sum() * solid_angle(pixel);
    }
    if (sum < least_share * total_) return std::nullopt;
    for (const std::size_t pixel : part.inside) map_.pixels[pixel] = narrow(surroundings);
    BrightSpot spot;
    spot.towards = normalized(red + green + blue);
    spot.irradiance = upper(Rgb{}, Rgb{dot(red, spot.towards), dot(green, spot.towards), dot(blue, spot.towards)});
    // A disk of even radiance has this solid angle.
    spot.angular_diameter = 2 * std::acos(std::clamp(1 - sum * sum / squares / (2 * pi), -1.0, 1.0));
    return spot;
  }

  EnvironmentMap& map_;
  std::vector<bool> is_tried_;
  double total_;
};

}  // namespace

std::vector<BrightSpot> take_bright_spots(EnvironmentMap& map) { return SpotFinder(map).take(); }

}  // namespace alvor
