#pragma once
// Lights of a scene that are not faces.

#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstdint>
#include <numbers>
#include <optional>
#include <string>

namespace alvor {

enum class LightKind : std::uint8_t {
  point,        ///< shines alike in all directions from `position`
  spot,         ///< shines from `position` into a cone about `direction`
  directional,  ///< shines from infinitely far away along `direction`; a sun if it has an angular diameter
};

/// A lamp or a distant light. With a radius or an angular diameter its shadows have soft edges; the light on a surface that sees
/// all of it is the same as without.
struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  /// Point, spot: radiant intensity, W/sr per band, in the middle of the cone for a spot. Directional: irradiance of a surface
  /// that faces the light, W/m2 per band. >= 0. In a photometric scene cd and lx.
  Rgb intensity;
  Vec3 position;             ///< point, spot: metres
  Vec3 direction{0, 0, -1};  ///< spot: axis of the cone; directional: the way the light travels. Unit
  /// Spot: angles between the axis and the edge of the bright cone, and between the axis and the edge of all light; radians, 0 <=
  /// inner <= outer, 0 < outer <= pi.
  double inner_cone = 0, outer_cone = std::numbers::pi / 4;
  double radius = 0;            ///< point, spot: of a sphere that shines, metres, >= 0
  double angular_diameter = 0;  ///< directional: radians, in [0, pi / 2]. The sun's is 0.0093

  friend bool operator==(const Light&, const Light&) = default;
  bool is_distant() const { return kind == LightKind::directional; }
};

/// The cones of a spot, with their cosines computed once.
class SpotCone {
 public:
  explicit SpotCone(const Light& spot);
  /// Returns the share of the spot's intensity at an angle from its axis, given the angle's cosine: 1 inside the inner cone, 0
  /// outside the outer one, between them the square of a linear function of the cosine (KHR_lights_punctual, "Inner and outer
  /// cone angles").
  double share(double cosine) const;
  /// Returns the integral of the share over all directions, steradians.
  double solid_angle() const;

 private:
  double cosine_of_edge_, width_;  ///< cosine of the outer cone; how much larger that of the inner cone is
};

/// Returns the power of a point or spot light, W per band: the integral of its intensity over all directions.
Rgb radiated_power(const Light& light);

/// Returns why the light cannot be used; nothing if it can.
std::optional<std::string> fault_in(const Light& light);

}  // namespace alvor
