#pragma once
// Light that comes from infinitely far away and from many directions, as the direct field sees it.

#include "meshing/sky_distribution.h"
#include "meshing/vec3.h"

#include <optional>

namespace alvor {

/// The radiance of a sky or an environment by direction, in multiples of a light's colour, 1/sr. Immutable.
class DistantRadiance {
 public:
  virtual ~DistantRadiance() = default;
  /// Returns the radiance from a direction (unit, towards the light). It may be averaged over a tenth of a radian about it, as
  /// rules of integration over windows need.
  virtual double smooth_radiance(Vec3 towards) const = 0;
  /// Returns the middle of the half of all directions from which light comes; nothing if it comes from all.
  virtual std::optional<Vec3> zenith() const = 0;
};

/// The radiance of a sky. Its colour is the irradiance of an open surface that faces the zenith.
class SkyRadiance final : public DistantRadiance {
 public:
  explicit SkyRadiance(const SkyDome& dome) : dome_(dome) {}
  double smooth_radiance(Vec3 towards) const override { return dome_.radiance(towards); }
  std::optional<Vec3> zenith() const override { return dome_.zenith(); }
  const SkyDome& dome() const { return dome_; }

 private:
  const SkyDome dome_;
};

}  // namespace alvor
