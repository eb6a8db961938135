#include "client/picture/tone_map.h"

#include "solution/srgb.h"

#include <algorithm>
#include <cmath>

namespace alvor {
namespace {

constexpr double middle = 0.25;        ///< logarithmic mean after exposure, before the curve
constexpr double bright = 1.2;         ///< limit of the brightest surfaces after exposure, before the curve
constexpr double bright_share = 0.02;  ///< fraction of the lit area that may be brighter
/// Surfaces darker than this fraction of the bright end count as this bright, so that deep shadow does not decide.
constexpr double darkest = 1e-3;

/// Returns the luminance that the fraction `share` of the weight exceeds. Sorts `areas`.
double upper_quantile(std::vector<LitArea>& areas, double share) {
  std::ranges::sort(areas, std::ranges::greater{}, &LitArea::luminance);
  double total = 0;
  for (const LitArea& area : areas) total += area.weight;
  double seen = 0;
  for (const LitArea& area : areas) {
    seen += area.weight;
    if (seen >= share * total) return area.luminance;
  }
  return areas.back().luminance;
}

double logarithmic_mean(const std::vector<LitArea>& areas, double least) {
  double sum = 0, weight = 0;
  for (const LitArea& area : areas) {
    sum += area.weight * std::log(std::max(area.luminance, least));
    weight += area.weight;
  }
  return std::exp(sum / weight);
}

/// Removes unlit areas, and emitters too if anything else is lit.
void keep_lit(std::vector<LitArea>& areas) {
  std::erase_if(areas, [](const LitArea& area) { return !(area.luminance > 0 && area.weight > 0); });
  const auto reflects = [](const LitArea& area) { return !area.emitter; };
  if (std::ranges::any_of(areas, reflects)) std::erase_if(areas, [](const LitArea& area) { return area.emitter; });
}

LitArea lit_area(const DisplayMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto [a, b, c] = triangle;
  const Vec3 twice_area = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
  const Rgb radiosity = widen(mesh.radiosity[a]) + widen(mesh.radiosity[b]) + widen(mesh.radiosity[c]);
  return {luminance(radiosity) / 3, length(twice_area) / 2, emits(mesh.radiosity[a], mesh.irradiance[a])};
}

/// Returns the filmic curve at x (Narkowicz 2015, "ACES filmic tone mapping curve").
double filmic(double x) {
  x = std::clamp(x, 0.0, 1e3);
  return std::min(1.0, x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));
}

}  // namespace

double automatic_exposure(std::vector<LitArea> areas) {
  keep_lit(areas);
  if (areas.empty()) return 1;
  const double high = upper_quantile(areas, bright_share);
  const double exposure = std::min(middle / logarithmic_mean(areas, darkest * high), bright / high);
  return std::isfinite(exposure) && exposure > 0 ? exposure : 1;
}

double automatic_exposure(const DisplayMesh& mesh) {
  std::vector<LitArea> areas;
  areas.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) areas.push_back(lit_area(mesh, triangle));
  return automatic_exposure(std::move(areas));
}

Rgb tone_map(const Rgb& exposed) { return {filmic(exposed.r), filmic(exposed.g), filmic(exposed.b)}; }

std::uint8_t srgb_byte(double linear) {
  linear = std::clamp(linear, 0.0, 1.0);
  const double encoded = srgb_of_linear(linear);
  return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

}  // namespace alvor
