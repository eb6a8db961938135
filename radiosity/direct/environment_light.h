#pragma once
// Light of an environment map on faces in the open.

#include "radiosity/direct/environment_band.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/direct/normal_table.h"
#include "radiosity/direct/scene_box.h"
#include "radiosity/direct/sky_exits.h"
#include "radiosity/rays/local_scene.h"

#include <memory>

namespace alvor {

/// One band of an environment, for open faces. Unblocked irradiance is interpolated in a table over normals. Half of the shadow
/// rays go in cosine-distributed directions about the receiver's normal, half in directions drawn by radiance; a weight is
/// radiance times cosine over the mean of both densities (balance heuristic, Veach & Guibas 1995).
class EnvironmentLight final : public LightSource {
 public:
  /// `power` is that of LightSource.
  EnvironmentLight(const LocalScene& scene, std::uint32_t number, std::shared_ptr<const EnvironmentBand> band,
                   const RelativeLight& colour, double power, std::shared_ptr<const SkyExits> exits);

  bool may_reach(std::uint32_t root) const override { return exits_->is_open[root]; }
  double unblocked(Vec3, Vec3 normal) const override { return irradiance_.at(normal); }
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override { return 1 / probability; }
  std::optional<LightExtent> extent() const override { return std::nullopt; }

 private:
  const std::shared_ptr<const EnvironmentBand> band_;
  const std::shared_ptr<const SkyExits> exits_;
  const SceneBox box_;
  const NormalTable irradiance_;
};

}  // namespace alvor
