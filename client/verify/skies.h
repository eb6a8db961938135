#pragma once
// The skies and environments of a scene, for the path tracer: their light is that of rays that leave the scene.

#include "client/verify/surroundings.h"
#include "meshing/light.h"

#include <span>
#include <utility>
#include <vector>

namespace alvor {

/// The radiance that comes from outside of a scene. Immutable.
class Skies {
 public:
  Skies() = default;
  explicit Skies(std::span<const Light> lights) : surroundings_(lights) {
    for (const Light& light : lights)
      if (light.kind == LightKind::sky && !light.intensity.is_zero()) domes_.emplace_back(light.intensity, SkyDome(light));
  }

  bool empty() const { return domes_.empty() && surroundings_.empty(); }
  /// Returns the radiance from a direction (unit), W/m2 sr per band.
  Rgb radiance(Vec3 towards) const { return of_skies(towards) + surroundings_.radiance(towards); }
  /// Returns the radiance without that of environments.
  Rgb of_skies(Vec3 towards) const {
    Rgb sum;
    for (const auto& [intensity, dome] : domes_) sum += dome.radiance(towards) * intensity;
    return sum;
  }

  const Surroundings& surroundings() const { return surroundings_; }

 private:
  std::vector<std::pair<Rgb, SkyDome>> domes_;
  Surroundings surroundings_;
};

}  // namespace alvor
