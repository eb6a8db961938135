#include "client/verify/surroundings.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

using std::numbers::pi;

}  // namespace

Surroundings::Surroundings(std::span<const Light> lights) {
  std::vector<double> areas;
  for (const Light& light : lights) {
    if (light.kind != LightKind::environment || light.intensity.is_zero()) continue;
    const auto& [columns, rows] = light.environment->grid;
    spheres_.push_back({light.across, cross(light.direction, light.across), -light.direction, columns, rows, pixels_.size()});
    for (std::size_t n = 0; n < light.environment->pixels.size(); ++n) {
      const double row = static_cast<double>(n / columns);
      areas.push_back(2 * pi / columns * 2 * std::sin(pi / rows / 2) * std::sin(pi * (row + 0.5) / rows));
      pixels_.push_back(light.intensity * widen(light.environment->pixels[n]));
    }
  }
  double all = 0;
  for (std::size_t n = 0; n < pixels_.size(); ++n) sums_.push_back(all += pixels_[n].sum() * areas[n]);
  if (all == 0) pixels_.clear();
  for (double& sum : sums_) sum /= all;
  for (const Rgb& pixel : pixels_) densities_.push_back(pixel.sum() / all);
}

std::size_t Surroundings::pixel_at(const Sphere& sphere, Vec3 towards) {
  const double down = std::acos(std::clamp(dot(towards, sphere.up), -1.0, 1.0)) / pi;
  const double around = 0.5 + std::atan2(dot(towards, sphere.right), dot(towards, sphere.ahead)) / (2 * pi);
  const auto step = [](double share, std::size_t count) {
    return std::min(count - 1, static_cast<std::size_t>(std::max(0.0, share * static_cast<double>(count))));
  };
  return sphere.first + step(down, sphere.rows) * sphere.columns + step(around, sphere.columns);
}

Rgb Surroundings::radiance(Vec3 towards) const {
  Rgb sum;
  if (empty()) return sum;
  for (const Sphere& sphere : spheres_) sum += pixels_[pixel_at(sphere, towards)];
  return sum;
}

double Surroundings::density(Vec3 towards) const {
  double sum = 0;
  for (const Sphere& sphere : spheres_) sum += densities_[pixel_at(sphere, towards)];
  return sum;
}

Vec3 Surroundings::sample(UnitPair at) const {
  const auto found = std::min<std::ptrdiff_t>(std::ranges::upper_bound(sums_, at.u) - sums_.begin(), std::ssize(sums_) - 1);
  const auto pixel = static_cast<std::size_t>(found);
  const double below = pixel > 0 ? sums_[pixel - 1] : 0, rest = std::clamp((at.u - below) / (sums_[pixel] - below), 0.0, 1.0);
  const Sphere* sphere = spheres_.data();
  while (sphere != &spheres_.back() && pixel >= (sphere + 1)->first) ++sphere;
  const auto row = static_cast<double>((pixel - sphere->first) / sphere->columns);
  const auto column = static_cast<double>((pixel - sphere->first) % sphere->columns);
  const auto rows = static_cast<double>(sphere->rows), columns = static_cast<double>(sphere->columns);
  const double height = std::lerp(std::cos(pi * row / rows), std::cos(pi * (row + 1) / rows), at.v);
  const double level = std::sqrt(std::max(0.0, 1 - height * height)), turn = 2 * pi * ((column + rest) / columns - 0.5);
  return height * sphere->up + level * (std::cos(turn) * sphere->ahead + std::sin(turn) * sphere->right);
}

}  // namespace alvor
