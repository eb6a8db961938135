#pragma once
// Lamps that shine from a point or a sphere.

#include "meshing/light.h"
#include "radiosity/direct/light_source.h"
#include "radiosity/rays/local_scene.h"

namespace alvor {

/// A point lamp, a spot, or a luminaire whose opening is a point or a sphere. Unblocked irradiance is I cos / d2. Shadow rays go
/// to the lamp's middle, or to a disk of its radius that faces the receiver: a sphere of even radiance sends I / d2 too, however
/// near (Lambert's law), while all of it is above the horizon. Closer than the radius, or than 1e-5 of the scene's extent, d is
/// that distance.
class LampLight final : public LightSource {
 public:
  /// `colour` is the irradiance, in the middle of a spot's cone or for a web's
  /// intensity of 1, of a surface that faces the lamp at a distance of one local
  /// unit. `power` is that of LightSource,
  /// `greatest` the greatest intensity of its web, or 1. Requires: `lamp` is of these kinds; !fault_in(lamp).
  LampLight(const LocalScene& scene, std::uint32_t number, const Light& lamp, const RelativeLight& colour, double power,
            double greatest);

  double unblocked(Vec3 at, Vec3 normal) const override;
  void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const override;
  double sample_scale(double probability) const override { return 1 / probability; }
  std::optional<LightExtent> extent() const override;

 private:
  double share(Vec3 direction) const;
  double share_over_distance_squared(Vec3 from_lamp, double squared) const;

  const Light lamp_;
  const std::optional<SpotCone> cone_;  ///< of a spot
  const std::optional<HungWeb> web_;    ///< of a luminaire
  const Vec3 place_;                    // local units, as all lengths below
  const double radius_, nearest_;
  const double greatest_;
};

}  // namespace alvor
