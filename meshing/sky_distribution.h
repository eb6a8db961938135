#pragma once
// The radiance of the sky by direction.

#include "meshing/vec3.h"

#include <optional>
#include <string>

namespace alvor {

struct Light;

/// How the radiance of a sky changes with direction, up to a factor: (1 + a exp(b / cos Z)) (1 + g cos Z) (1 + c (exp(d chi) -
/// exp(d pi / 2)) + e cos2 chi), at least 0. Z is the angle from the zenith, chi the angle from the sun. All 0: a uniform sky. a
/// to e are those of the CIE standard general skies (ISO 15469:2004) and of Perez et al. (1993); g = 2 is the overcast sky of
/// Moon and Spencer, (1 + 2 cos Z) / 3.
struct SkyDistribution {
  double a = 0, b = 0, c = 0, d = 0, e = 0;
  double g = 0;
  Vec3 to_sun{0, 1, 0};  ///< unit

  friend bool operator==(const SkyDistribution&, const SkyDistribution&) = default;
};

/// Returns the CIE standard general sky of this number. Requires: 1 <= number <= 15.
SkyDistribution cie_sky(int number, Vec3 to_sun);

/// Returns the sky of Perez et al. (1993), "All-weather model for sky luminance distribution". `direct_normal` and
/// `diffuse_horizontal` are irradiances in W/m2, `zenith` is the angle of the sun from the zenith, radians.
SkyDistribution perez_sky(double direct_normal, double diffuse_horizontal, double zenith, Vec3 to_sun);

/// Returns why the distribution cannot be used; nothing if it can.
std::optional<std::string> fault_in(const SkyDistribution& sky);

/// The half of all directions from which a sky shines.
class SkyDome {
 public:
  /// Requires: a sky; !fault_in(sky).
  explicit SkyDome(const Light& sky);
  /// Returns the radiance from a direction (unit, towards the sky) in multiples of the sky's intensity, 1/sr; 0 below the
  /// horizon. Its integral over the dome times the cosine from the zenith is 1.
  double radiance(Vec3 towards) const;
  Vec3 zenith() const { return zenith_; }

 private:
  double relative(Vec3 towards) const;

  Vec3 zenith_, to_sun_;
  double a_, b_, c_, d_, e_, g_;
  double at_right_angle_;  ///< exp(d pi / 2)
  double scale_ = 1;
};

}  // namespace alvor
