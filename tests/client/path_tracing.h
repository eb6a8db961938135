#pragma once
// Scenes and expectations for tests of path tracing.

#include "client/verify/irradiance_estimate.h"
#include "tests/scenes.h"

#include <cmath>
#include <numbers>
#include <span>

namespace alvor {

inline constexpr double sure = 4;  ///< standard errors: exceeded once in 16 000 cases, and the seed is fixed

inline IrradianceEstimate traced(const Scene& scene, const SurfacePoint& point, std::uint64_t paths = 4096) {
  return trace_irradiance(PathTracer(scene), std::span(&point, 1), {.paths = paths, .threads = 1}).front();
}

inline double error_of(const IrradianceEstimate& estimate) { return std::sqrt(estimate.variance_of_band_mean()); }

/// Adds a black floor about the z axis at height 0.
inline void add_black_floor(Scene& scene, double side) {
  const double h = side / 2;
  const auto black = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(test::grey(0, 0));
  test::add_polygon(scene, {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, black);
}

/// Adds a square of this side about the z axis at height z, facing down.
inline void add_ceiling(Scene& scene, double side, double z, std::uint32_t material) {
  const double h = side / 2;
  test::add_polygon(scene, {{-h, -h, z}, {-h, h, z}, {h, h, z}, {h, -h, z}}, material);
}

/// Returns the form factor from a point to a parallel rectangle of sides a, b at distance 1, whose corner is above the point.
inline double corner_form_factor(double a, double b) {
  const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * std::numbers::pi);
}

}  // namespace alvor
