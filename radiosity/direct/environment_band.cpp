#include "radiosity/direct/environment_band.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

using std::numbers::pi;

// Pixels of the grid that exits use: 0.1 radians wide, the distance of the points that FaceIntegral takes.
constexpr std::uint32_t smooth_columns = 64, smooth_rows = 32;
// Groups of pixels for the irradiance of open surfaces: 0.05 radians wide.
constexpr std::uint32_t group_columns = 128, group_rows = 64;
// Groups that are summed side by side.
constexpr std::size_t lanes = 8;
// Share of its light by which the colour of an environment may differ from its mean colour and still count as one.
constexpr double one_colour = 0.01;

/// Returns the map of one band, or of the mean of bands that are alike, as grey radiance.
std::vector<double> weighted(const EnvironmentMap& map, const Rgb& bands) {
  std::vector<double> radiance;
  for (const RgbF& pixel : map.pixels) radiance.push_back((bands * widen(pixel)).sum());
  return radiance;
}

}  // namespace

EnvironmentBand::EnvironmentBand(const Light& environment, const Rgb& bands)
    : axes_(environment), grid_(environment.environment->grid), radiance_(weighted(*environment.environment, bands)) {
  const Rgb total = environment.environment->total();
  const Rgb is_in{bands.r > 0 ? 1.0 : 0.0, bands.g > 0 ? 1.0 : 0.0, bands.b > 0 ? 1.0 : 0.0};
  colour_ = is_in * environment.intensity * total;
  const double sends = (bands * total).sum();
  for (double& radiance : radiance_) radiance /= sends;
  fill_sums();
  fill_groups();
  const EnvironmentMap smooth = reduced(*environment.environment, smooth_columns, smooth_rows);
  smooth_grid_ = smooth.grid;
  smooth_ = weighted(smooth, bands);
  for (double& radiance : smooth_) radiance /= sends;
}

void EnvironmentBand::fill_sums() {
  double sum = 0;
  for (std::uint32_t row = 0; row < grid_.rows; ++row) {
    double of_row = 0;
    for (std::uint32_t column = 0; column < grid_.columns; ++column)
      within_rows_.push_back(of_row += radiance_[std::size_t{row} * grid_.columns + column]);
    of_rows_.push_back(sum += of_row * grid_.solid_angle(row));
  }
}

// Pixels that are larger than a group are cut, so that the horizon cuts none that is large.
void EnvironmentBand::fill_groups() {
  const std::uint32_t cut_columns = (group_columns + grid_.columns - 1) / grid_.columns;
  const std::uint32_t cut_rows = (group_rows + grid_.rows - 1) / grid_.rows;
  const SphereGrid pieces{grid_.columns * cut_columns, grid_.rows * cut_rows};
  const SphereGrid groups{std::min(pieces.columns, group_columns), std::min(pieces.rows, group_rows)};
  std::vector<Vec3> sums((groups.size() + lanes - 1) / lanes * lanes);
  for (std::uint32_t row = 0; row < pieces.rows; ++row)
    for (std::uint32_t column = 0; column < pieces.columns; ++column) {
      const double radiance = radiance_[std::size_t{row / cut_rows} * grid_.columns + column / cut_columns];
      const std::size_t group =
          std::size_t{row * groups.rows / pieces.rows} * groups.columns + column * groups.columns / pieces.columns;
      sums[group] += radiance * axes_.to_scene(pieces.direction_sum(row, column));
    }
  for (const Vec3& sum : sums) {
    x_.push_back(static_cast<float>(sum.x));
    y_.push_back(static_cast<float>(sum.y));
    z_.push_back(static_cast<float>(sum.z));
  }
}

double EnvironmentBand::irradiance(Vec3 normal) const {
  const auto x = static_cast<float>(normal.x), y = static_cast<float>(normal.y), z = static_cast<float>(normal.z);
  std::array<float, lanes> sums{};
  for (std::size_t group = 0; group < x_.size(); group += lanes)
    for (std::size_t n = 0; n < lanes; ++n) sums[n] += std::max(0.0f, x * x_[group + n] + y * y_[group + n] + z * z_[group + n]);
  double sum = 0;
  for (const float part : sums) sum += double{part};
  return sum;
}

Vec3 EnvironmentBand::drawn(double u, double v) const {
  const double wanted = v * of_rows_.back();
  const auto row = static_cast<std::uint32_t>(
      std::min(std::ranges::upper_bound(of_rows_, wanted) - of_rows_.begin(), std::ptrdiff_t{grid_.rows} - 1));
  const double above = row > 0 ? of_rows_[row - 1] : 0, rest_v = (wanted - above) / (of_rows_[row] - above);
  const auto sums = std::span(within_rows_).subspan(std::size_t{row} * grid_.columns, grid_.columns);
  const double wanted_here = u * sums.back();
  const auto column = static_cast<std::uint32_t>(
      std::min(std::ranges::upper_bound(sums, wanted_here) - sums.begin(), std::ptrdiff_t{grid_.columns} - 1));
  const double before = column > 0 ? sums[column - 1] : 0, rest_u = (wanted_here - before) / (sums[column] - before);
  // Uniform by solid angle within the pixel: in the cosine from the zenith and in the longitude.
  const double top = std::cos(pi * row / grid_.rows), bottom = std::cos(pi * (row + 1) / grid_.rows);
  const double cosine = top + std::clamp(rest_v, 0.0, 1.0) * (bottom - top), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double turn = 2 * pi * (column + std::clamp(rest_u, 0.0, 1.0)) / grid_.columns - pi;
  return axes_.to_scene({sine * std::cos(turn), sine * std::sin(turn), cosine});
}

// Bilinear between the middles of pixels.
double EnvironmentBand::smooth_radiance(Vec3 towards) const {
  const Vec3 direction = axes_.to_grid(towards);
  const int columns = static_cast<int>(smooth_grid_.columns), rows = static_cast<int>(smooth_grid_.rows);
  const double v = std::acos(std::clamp(direction.z, -1.0, 1.0)) / pi * rows - 0.5;
  const double u = (std::atan2(direction.y, direction.x) / (2 * pi) + 0.5) * columns - 0.5;
  const double top = std::floor(v), left = std::floor(u);
  const auto at = [&](double row, double column) {
    const int r = std::clamp(static_cast<int>(row), 0, rows - 1), c = (static_cast<int>(column) + columns) % columns;
    return smooth_[static_cast<std::size_t>(r * columns + c)];
  };
  const double across = u - left, down = v - top;
  return (1 - down) * ((1 - across) * at(top, left) + across * at(top, left + 1)) +
         down * ((1 - across) * at(top + 1, left) + across * at(top + 1, left + 1));
}

std::vector<Rgb> bands_of(const EnvironmentMap& map) {
  const Rgb total = map.total();
  const double all = total.sum();
  double differs = 0;
  for (std::uint32_t row = 0; row < map.grid.rows; ++row)
    for (std::uint32_t column = 0; column < map.grid.columns; ++column) {
      const Rgb pixel = widen(map.pixels[std::size_t{row} * map.grid.columns + column]);
      differs += map.grid.solid_angle(row) * absolute(pixel - pixel.sum() / all * total).sum();
    }
  const Rgb is_lit{total.r > 0 ? 1.0 : 0.0, total.g > 0 ? 1.0 : 0.0, total.b > 0 ? 1.0 : 0.0};
  if (all == 0) return {};
  if (differs <= one_colour * all) return {is_lit};
  std::vector<Rgb> bands;
  for (const Rgb& band : {Rgb{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})
    if (!(band * is_lit).is_zero()) bands.push_back(band);
  return bands;
}

}  // namespace alvor
