#include "meshing/sky_distribution.h"

#include "meshing/tangent_frame.h"

#include "meshing/light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

using std::numbers::pi;

// a, b, c, d, e of the fifteen CIE standard general skies (ISO 15469:2004, table 1).
constexpr std::array<std::array<double, 5>, 15> cie_skies{{{4, -0.7, 0, -1, 0},
                                                           {4, -0.7, 2, -1.5, 0.15},
                                                           {1.1, -0.8, 0, -1, 0},
                                                           {1.1, -0.8, 2, -1.5, 0.15},
                                                           {0, -1, 0, -1, 0},
                                                           {0, -1, 2, -1.5, 0.15},
                                                           {0, -1, 5, -2.5, 0.3},
                                                           {0, -1, 10, -3, 0.45},
                                                           {-1, -0.55, 2, -1.5, 0.15},
                                                           {-1, -0.55, 5, -2.5, 0.3},
                                                           {-1, -0.55, 10, -3, 0.45},
                                                           {-1, -0.32, 10, -3, 0.45},
                                                           {-1, -0.32, 16, -3, 0.3},
                                                           {-1, -0.15, 16, -3, 0.3},
                                                           {-1, -0.15, 24, -2.8, 0.15}}};

// Perez et al. (1993), table 1: by clearness, then a to e, each x1 + x2 z + brightness (x3 + x4 z) with the sun's angle z from
// the zenith.
constexpr std::array<double, 7> perez_clearness{1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2};
using PerezRow = std::array<std::array<double, 4>, 5>;
constexpr std::array<PerezRow, 8> perez_rows{{{{{1.3525, -0.2576, -0.2690, -1.4366},
                                                {-0.7670, 0.0007, 1.2734, -0.1233},
                                                {2.8000, 0.6004, 1.2375, 1.0000},
                                                {1.8734, 0.6297, 0.9738, 0.2809},
                                                {0.0356, -0.1246, -0.5718, 0.9938}}},
                                              {{{-1.2219, -0.7730, 1.4148, 1.1016},
                                                {-0.2054, 0.0367, -3.9128, 0.9156},
                                                {6.9750, 0.1774, 6.4477, -0.1239},
                                                {-1.5798, -0.5081, -1.7812, 0.1080},
                                                {0.2624, 0.0672, -0.2190, -0.4285}}},
                                              {{{-1.1000, -0.2515, 0.8952, 0.0156},
                                                {0.2782, -0.1812, -4.5000, 1.1766},
                                                {24.7219, -13.0812, -37.7000, 34.8438},
                                                {-5.0000, 1.5218, 3.9229, -2.6204},
                                                {-0.0156, 0.1597, 0.4199, -0.5562}}},
                                              {{{-0.5484, -0.6654, -0.2672, 0.7117},
                                                {0.7234, -0.6219, -5.6812, 2.6297},
                                                {33.3389, -18.3000, -62.2500, 52.0781},
                                                {-3.5000, 0.0016, 1.1477, 0.1062},
                                                {0.4659, -0.3296, -0.0876, -0.0329}}},
                                              {{{-0.6000, -0.3566, -2.5000, 2.3250},
                                                {0.2937, 0.0496, -5.6812, 1.8415},
                                                {21.0000, -4.7656, -21.5906, 7.2492},
                                                {-3.5000, -0.1554, 1.4062, 0.3988},
                                                {0.0032, 0.0766, -0.0656, -0.1294}}},
                                              {{{-1.0156, -0.3670, 1.0078, 1.4051},
                                                {0.2875, -0.5328, -3.8500, 3.3750},
                                                {14.0000, -0.9999, -7.1406, 7.5469},
                                                {-3.4000, -0.1078, -1.0750, 1.5702},
                                                {-0.0672, 0.4016, 0.3017, -0.4844}}},
                                              {{{-1.0000, 0.0211, 0.5025, -0.5119},
                                                {-0.3000, 0.1922, 0.7023, -1.6317},
                                                {19.0000, -5.0000, 1.2438, -1.9094},
                                                {-4.0000, 0.0250, 0.3844, 0.2656},
                                                {1.0468, -0.3788, -2.4517, 1.4656}}},
                                              {{{-1.0500, 0.0289, 0.4260, 0.3590},
                                                {-0.3250, 0.1156, 0.7781, 0.0025},
                                                {31.0625, -14.5000, -46.1148, 55.3750},
                                                {-7.2312, 0.4050, 13.3500, 0.6234},
                                                {1.5000, -0.6426, 1.8564, 0.5636}}}}};
constexpr double solar_constant = 1367;  // W/m2, as in that paper
constexpr double max_coefficient = 1000;
// Cosine from the zenith below which the radiance is that at this cosine, so that exp(b / cos Z) stays a number.
constexpr double lowest_cosine = 0.01;
constexpr double largest_exponent = 20;
// Steps of the rule that normalises a sky: the midpoint rule in the squared sine from the zenith and in azimuth.
constexpr int rings = 256, sectors = 128;

/// Returns the relative optical air mass (Kasten 1966).
double air_mass(double zenith) {
  const double degrees = std::min(zenith * 180 / pi, 90.0);
  return 1 / (std::cos(degrees * pi / 180) + 0.15 * std::pow(93.885 - degrees, -1.253));
}

}  // namespace

SkyDistribution cie_sky(int number, Vec3 to_sun) {
  const auto& [a, b, c, d, e] = cie_skies.at(static_cast<std::size_t>(number - 1));
  return {a, b, c, d, e, 0, to_sun};
}

SkyDistribution perez_sky(double direct_normal, double diffuse_horizontal, double zenith, Vec3 to_sun) {
  const double cubed = 1.041 * zenith * zenith * zenith;
  const double clearness = ((diffuse_horizontal + direct_normal) / diffuse_horizontal + cubed) / (1 + cubed);
  double brightness = std::clamp(diffuse_horizontal * air_mass(zenith) / solar_constant, 0.01, 0.6);
  // The fits of these clearnesses are not meant for darker skies.
  if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, 0.2);
  const auto bin = static_cast<std::size_t>(std::ranges::upper_bound(perez_clearness, clearness) - perez_clearness.begin());
  const PerezRow& row = perez_rows[bin];
  const auto fit = [&](const std::array<double, 4>& x) { return x[0] + x[1] * zenith + brightness * (x[2] + x[3] * zenith); };
  double c = fit(row[2]), d = fit(row[3]);
  if (bin == 0) {
    c = std::exp(std::pow(brightness * (row[2][0] + row[2][1] * zenith), row[2][2])) - row[2][3];
    d = -std::exp(brightness * (row[3][0] + row[3][1] * zenith)) + row[3][2] + brightness * row[3][3];
  }
  // Perez has 1 + c exp(d chi) + e cos2 chi, without the term c exp(d pi / 2) of the CIE skies: the same up to a factor with
  const double factor = 1 / (1 + c * std::exp(std::min(largest_exponent, d * pi / 2)));
  // For weather that does not occur b comes out positive, and the horizon would grow without bound.
  return {fit(row[0]), std::min(0.0, fit(row[1])), factor * c, d, factor * fit(row[4]), 0, to_sun};
}

std::optional<std::string> fault_in(const SkyDistribution& sky) {
  for (const double x : {sky.a, sky.b, sky.c, sky.d, sky.e, sky.g})
    if (!(std::abs(x) <= max_coefficient)) return "a coefficient of the sky is not within [-1000, 1000]";
  if (!(std::abs(dot(sky.to_sun, sky.to_sun) - 1) < 1e-6)) return "the direction to the sun in the sky is not a unit vector";
  return std::nullopt;
}

SkyDome::SkyDome(const Light& sky)
    : zenith_(-sky.direction),
      to_sun_(sky.sky.to_sun),
      a_(sky.sky.a),
      b_(sky.sky.b),
      c_(sky.sky.c),
      d_(sky.sky.d),
      e_(sky.sky.e),
      g_(sky.sky.g),
      at_right_angle_(std::exp(std::min(largest_exponent, sky.sky.d * pi / 2))) {
  const TangentFrame level(zenith_);
  double sum = 0;
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      const double squared_sine = (ring + 0.5) / rings, turn = 2 * pi * (sector + 0.5) / sectors;
      const double sine = std::sqrt(squared_sine);
      sum += relative(std::sqrt(1 - squared_sine) * zenith_ + sine * std::cos(turn) * level.s + sine * std::sin(turn) * level.t);
    }
  // The integral of cos Z over a step is pi / (rings sectors).
  const double integral = pi * sum / (rings * sectors);
  scale_ = integral > 0 ? 1 / integral : 0;
}

double SkyDome::radiance(Vec3 towards) const { return dot(towards, zenith_) > 0 ? scale_ * relative(towards) : 0; }

double SkyDome::relative(Vec3 towards) const {
  const double cosine = std::max(lowest_cosine, dot(towards, zenith_));
  double value = 1 + g_ * cosine;
  if (a_ != 0) value *= 1 + a_ * std::exp(std::min(largest_exponent, b_ / cosine));
  if (c_ != 0 || e_ != 0) {
    const double from_sun = std::clamp(dot(towards, to_sun_), -1.0, 1.0);
    value *=
        1 + c_ * (std::exp(std::min(largest_exponent, d_ * std::acos(from_sun))) - at_right_angle_) + e_ * from_sun * from_sun;
  }
  return std::max(0.0, value);
}

}  // namespace alvor
