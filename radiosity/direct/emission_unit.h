#pragma once
// The unit in which the solver counts light.

#include "meshing/base_mesh.h"
#include "solution/relative_light.h"

#include <algorithm>
#include <unordered_map>

namespace alvor {

/// Converts between W/m2 and emission units. One emission unit is the brightest emission of the scene in any band, W/m2; 1 W/m2
/// if nothing emits. A lamp counts by its irradiance at a distance of the scene's extent,
/// an environment by the integral of its radiance. Inside direct, exchange, estimate and
/// solve all light and power are multiples of it, so that squares stay within the range of numbers however bright or dim a scene
/// is. Light per band has the type RelativeLight; sums and means over bands are plain numbers. There are two places that convert:
/// lights_of_scene.cpp on the way in (emissions, lamps, distant lights), and SolveState on the way out (irradiance of leaves,
/// ambient irradiance, power balance).
class EmissionUnit {
 public:
  explicit EmissionUnit(const BaseMesh& mesh) {
    double brightest = 0;
    std::unordered_map<const PhotometricWeb*, double> greatest;  // many lights may share a web
    for (std::uint32_t root = 0; root < mesh.roots().size(); ++root)
      brightest = std::max(brightest, mesh.material_of(root).emission.max());
    for (const Light& light : mesh.lights()) {
      const double squared = light.is_distant() ? 1 : mesh.extent() * mesh.extent();
      const auto [web, is_new] = greatest.try_emplace(light.web.get(), 1);
      if (is_new && light.web) web->second = light.web->greatest();
      const double factor = light.kind == LightKind::environment ? light.environment->total().max() : web->second;
      brightest = std::max(brightest, light.intensity.max() * factor / squared);
    }
    if (brightest > 0) watts_per_m2_ = brightest;
  }

  /// Returns W/m2 as emission units.
  RelativeLight from_watts_per_m2(const Rgb& light) const {
    const double scale = 1 / watts_per_m2_;
    return {scale * light.r, scale * light.g, scale * light.b};
  }
  /// Returns emission units as W/m2.
  Rgb to_watts_per_m2(const RelativeLight& light) const {
    return {watts_per_m2_ * light.r, watts_per_m2_ * light.g, watts_per_m2_ * light.b};
  }
  /// Returns W for a power in emission units times m2.
  double to_watts(double power) const { return watts_per_m2_ * power; }

 private:
  double watts_per_m2_ = 1;
};

}  // namespace alvor
