#pragma once
// Light from one direction: the sun, or a directional light.

#include "meshing/light.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/direct/scene_box.h"
#include "radiosity/rays/local_scene.h"

namespace alvor {

/// A light so far away that it shines from one direction on all of the scene. Unblocked irradiance is E cos. Shadow rays end
/// where they leave the scene's bounding box; with an angular diameter they point to a disk of that width. A medium fills the box
/// only.
class DistantLight final : public LightSource {
 public:
  /// `colour` is the irradiance of a surface that faces the light. The light's power is what first meets fronts, estimated by
  /// 4096 parallel rays. Requires: `light` is distant; !fault_in(light).
  DistantLight(const LocalScene& scene, std::uint32_t number, const Light& light, const RelativeLight& colour);

  double unblocked(Vec3 at, Vec3 normal) const override;
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override { return 1 / probability; }
  std::optional<LightExtent> extent() const override { return std::nullopt; }

 private:
  const Vec3 towards_;       // unit, from the scene to the light
  const double half_width_;  // tangent of half the angular diameter
  const SceneBox box_;
};

}  // namespace alvor
