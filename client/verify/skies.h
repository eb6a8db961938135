#pragma once
// The skies of a scene, for the path tracer: their light is that of rays that leave the scene.

#include "meshing/light.h"

#include <span>
#include <utility>
#include <vector>

namespace alvor {

/// The radiance that comes from outside of a scene. Immutable.
class Skies {
 public:
  Skies() = default;
  explicit Skies(std::span<const Light> lights) {
    for (const Light& light : lights)
      if (light.kind == LightKind::sky && !light.intensity.is_zero()) domes_.emplace_back(light.intensity, SkyDome(light));
  }

  bool empty() const { return domes_.empty(); }
  /// Returns the radiance from a direction (unit), W/m2 sr per band.
  Rgb radiance(Vec3 towards) const {
    Rgb sum;
    for (const auto& [intensity, dome] : domes_) sum += dome.radiance(towards) * intensity;
    return sum;
  }

 private:
  std::vector<std::pair<Rgb, SkyDome>> domes_;
};

}  // namespace alvor
