#include "meshing/environment_map.h"

#include "meshing/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

using std::numbers::pi;

constexpr float max_radiance = 1e30f;

double angle_of_row(const SphereGrid& grid, double row) { return pi * row / grid.rows; }
double longitude_of(const SphereGrid& grid, double column) { return 2 * pi * column / grid.columns - pi; }

/// Calls visit(target, share) for each of `to` equal pieces of a length that piece `n` of `from` equal pieces overlaps. `share`
/// is the part of the overlap in piece `n`, as its two ends in pieces of `from`.
template <class Visit>
void for_each_overlap(std::uint32_t n, std::uint32_t from, std::uint32_t to, Visit&& visit) {
  const double ratio = double(from) / to;
  for (auto target = static_cast<std::uint32_t>(n / ratio); target < to && target * ratio < n + 1; ++target) {
    const double low = std::max(double(n), target * ratio), high = std::min(n + 1.0, (target + 1) * ratio);
    if (high > low) visit(target, low, high);
  }
}

}  // namespace

double SphereGrid::solid_angle(std::uint32_t row) const {
  return 2 * pi / columns * (std::cos(angle_of_row(*this, row)) - std::cos(angle_of_row(*this, row + 1.0)));
}

Vec3 SphereGrid::direction_sum(std::uint32_t row, std::uint32_t column) const {
  const double top = angle_of_row(*this, row), bottom = angle_of_row(*this, row + 1.0);
  const double left = longitude_of(*this, column), right = longitude_of(*this, column + 1.0);
  // Integrals of sin2 and of sin cos over the angle from the zenith.
  const double flat = (bottom - top) / 2 - (std::sin(2 * bottom) - std::sin(2 * top)) / 4;
  const double upright = (std::cos(2 * top) - std::cos(2 * bottom)) / 4;
  return {flat * (std::sin(right) - std::sin(left)), flat * (std::cos(left) - std::cos(right)), upright * (right - left)};
}

Vec3 SphereGrid::direction_at(double u, double v) const {
  const double angle = angle_of_row(*this, v), turn = longitude_of(*this, u);
  return {std::sin(angle) * std::cos(turn), std::sin(angle) * std::sin(turn), std::cos(angle)};
}

std::size_t SphereGrid::pixel_at(Vec3 direction) const {
  const double v = std::acos(std::clamp(direction.z, -1.0, 1.0)) / pi * rows;
  const double u = (std::atan2(direction.y, direction.x) / (2 * pi) + 0.5) * columns;
  const auto row = std::min(static_cast<std::size_t>(v), std::size_t{rows} - 1);
  const auto column = std::min(static_cast<std::size_t>(std::max(0.0, u)), std::size_t{columns} - 1);
  return row * columns + column;
}

Rgb EnvironmentMap::total() const {
  Rgb sum;
  for (std::uint32_t row = 0; row < grid.rows; ++row) {
    Rgb of_row;
    for (std::uint32_t column = 0; column < grid.columns; ++column)
      of_row += widen(pixels[std::size_t{row} * grid.columns + column]);
    sum += grid.solid_angle(row) * of_row;
  }
  return sum;
}

std::optional<std::string> fault_in(const EnvironmentMap& map) {
  const auto& [columns, rows] = map.grid;
  if (columns == 0 || rows == 0 || columns > EnvironmentMap::most_columns || rows > EnvironmentMap::most_rows)
    return "its environment map has " + std::to_string(columns) + " x " + std::to_string(rows) +
           " pixels, not 1 x 1 to 256 x 128";
  if (map.pixels.size() != map.grid.size())
    return "its environment map of " + std::to_string(columns) + " x " + std::to_string(rows) + " has " +
           std::to_string(map.pixels.size()) + " pixels";
  for (const RgbF& pixel : map.pixels)
    for (const float band : {pixel.r, pixel.g, pixel.b})
      if (!(band >= 0 && band <= max_radiance)) return "a radiance of its environment map is outside [0, 1e30]";
  return std::nullopt;
}

EnvironmentAxes::EnvironmentAxes(const Light& environment)
    : ahead(environment.across), right(cross(environment.direction, environment.across)), up(-environment.direction) {}

EnvironmentReduction::EnvironmentReduction(SphereGrid from, SphereGrid to) : from_(from), sums_(to.size()), row_(to.columns) {
  map_.grid = to;
}

void EnvironmentReduction::add_row(std::span<const float> rgb) {
  const SphereGrid& to = map_.grid;
  std::ranges::fill(row_, Rgb{});
  for (std::uint32_t column = 0; column < from_.columns; ++column) {
    const Rgb pixel{rgb[3 * column], rgb[3 * column + 1], rgb[3 * column + 2]};
    for_each_overlap(column, from_.columns, to.columns, [&](std::uint32_t target, double low, double high) {
      row_[target] += (high - low) * to.columns / from_.columns * pixel;
    });
  }
  for_each_overlap(next_row_++, from_.rows, to.rows, [&](std::uint32_t target, double low, double high) {
    const double overlap = std::cos(angle_of_row(from_, low)) - std::cos(angle_of_row(from_, high));
    const double share = overlap * 2 * pi / to.columns / to.solid_angle(target);
    for (std::uint32_t column = 0; column < to.columns; ++column)
      sums_[std::size_t{target} * to.columns + column] += share * row_[column];
  });
}

EnvironmentMap EnvironmentReduction::take() {
  for (const Rgb& sum : sums_) map_.pixels.push_back(narrow(lower(sum, Rgb{max_radiance, max_radiance, max_radiance})));
  return std::move(map_);
}

EnvironmentMap reduced(const EnvironmentMap& map, std::uint32_t most_columns, std::uint32_t most_rows) {
  const SphereGrid to{std::min(map.grid.columns, most_columns), std::min(map.grid.rows, most_rows)};
  if (to == map.grid) return map;
  EnvironmentReduction reduction(map.grid, to);
  std::vector<float> row(std::size_t{3} * map.grid.columns);
  for (std::uint32_t r = 0; r < map.grid.rows; ++r) {
    for (std::uint32_t c = 0; c < map.grid.columns; ++c) {
      const RgbF& pixel = map.pixels[std::size_t{r} * map.grid.columns + c];
      row[3 * c] = pixel.r, row[3 * c + 1] = pixel.g, row[3 * c + 2] = pixel.b;
    }
    reduction.add_row(row);
  }
  return reduction.take();
}

}  // namespace alvor
