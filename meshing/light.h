#pragma once
// Lights of a scene that are not faces.

#include "meshing/environment_map.h"
#include "meshing/photometric_web.h"
#include "meshing/placement.h"
#include "meshing/sky_distribution.h"
#include "meshing/vec3.h"
#include "solution/rgb.h"

#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

namespace alvor {

enum class LightKind : std::uint8_t {
  point,        ///< shines alike in all directions from `position`
  spot,         ///< shines from `position` into a cone about `direction`
  directional,  ///< shines from infinitely far away along `direction`; a sun if it has an angular diameter
  luminaire,    ///< shines from an opening about `position` as its photometric web says (IES, EULUMDAT)
  sky,          ///< shines from infinitely far away, from the half of all directions about `-direction`; also a bright ground
  environment,  ///< shines from infinitely far away, from all directions, as its environment map says
};

/// The part of a luminaire that shines, centred on its position. Sizes in metres, >= 0.
struct LuminousOpening {
  enum class Shape : std::uint8_t {
    point,
    rectangle,  ///< `across` x `along`, perpendicular to the aim
    ellipse,    ///< the same with these diameters
    box,        ///< `across` x `along` x `height`, its sides shine too
    cylinder,   ///< an upright one with these diameters; its side shines too
    sphere,     ///< diameter `across`
  };
  Shape shape = Shape::point;
  double across = 0;  ///< in the direction of the luminaire's axis `across`
  double along = 0;   ///< perpendicular to that axis and to the aim
  double height = 0;  ///< in the direction of the aim

  friend bool operator==(const LuminousOpening&, const LuminousOpening&) = default;
};

/// A lamp or a distant light. With a radius or an angular diameter its shadows have soft edges; the light on a surface that sees
/// all of it is the same as without.
struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  /// Point, spot: radiant intensity, W/sr per band, in the middle of the cone for a spot. Directional: irradiance of a surface
  /// that faces the light, W/m2 per band. >= 0. In a photometric scene cd and lx. Luminaire: a factor for the intensities of its
  /// web. Sky: irradiance of an open surface that faces its zenith, W/m2 or lx. Environment: a factor for the radiance of its
  /// map.
  Rgb intensity;
  Vec3 position;  ///< point, spot: metres; luminaire: its photometric centre
  /// Spot: axis of the cone; directional: the way the light travels; luminaire: its aim, where both angles of the web are 0;
  /// sky, environment: from the zenith. Unit.
  Vec3 direction{0, 0, -1};
  /// Spot: angles between the axis and the edge of the bright cone, and between the axis and the edge of all light; radians, 0 <=
  /// inner <= outer, 0 < outer <= pi.
  double inner_cone = 0, outer_cone = std::numbers::pi / 4;
  double radius = 0;                          ///< point, spot: of a sphere that shines, metres, >= 0
  double angular_diameter = 0;                ///< directional: radians, in [0, pi / 2]. The sun's is 0.0093
  std::shared_ptr<const PhotometricWeb> web;  ///< luminaire: not null; lights may share it
  /// Luminaire: the web's plane 0 or axis; environment: to the middle of its map. Unit, perpendicular to `direction`.
  Vec3 across{1, 0, 0};
  LuminousOpening opening;                            ///< luminaire
  bool is_hidden = false;                             ///< an edit took away the object that it came with; it is black
  double electrical_watts = 0;                        ///< luminaire: power that it draws, W, for reports; 0: not known
  SkyDistribution sky;                                ///< sky
  std::shared_ptr<const EnvironmentMap> environment;  ///< environment: not null; lights may share it

  friend bool operator==(const Light& a, const Light& b);
  /// Returns whether it shines otherwise into other directions, and may be aimed.
  bool has_direction() const { return kind == LightKind::spot || kind == LightKind::directional || kind == LightKind::luminaire; }
  bool is_distant() const { return kind == LightKind::directional || kind == LightKind::sky || kind == LightKind::environment; }
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

/// The photometric web of a luminaire as it hangs.
class HungWeb {
 public:
  /// Requires: a luminaire; !fault_in(luminaire).
  explicit HungWeb(const Light& luminaire)
      : web_(luminaire.web),
        across_(luminaire.across),
        along_(cross(luminaire.across, luminaire.direction)),
        aim_(luminaire.direction) {}
  /// Returns the intensity that the web tells for a direction. Requires: a unit vector.
  double intensity(Vec3 direction) const {
    return web_->intensity({dot(direction, across_), dot(direction, along_), dot(direction, aim_)});
  }
  const PhotometricWeb& web() const { return *web_; }
  Vec3 across() const { return across_; }
  Vec3 along() const { return along_; }  ///< perpendicular to both others
  Vec3 aim() const { return aim_; }

 private:
  std::shared_ptr<const PhotometricWeb> web_;
  Vec3 across_, along_, aim_;
};

/// Returns the radius about its position, metres, within which all of a light lies that is not distant.
double radius_of(const Light& light);

/// Returns a light that is not distant where a motion takes it, which turns, shifts and changes all sizes by one factor. Its
/// intensity stays. The identity changes no bit.
Light moved(Light light, const Placement& motion);

/// Returns the power of a light that is not distant, W per band: the integral of its intensity over all directions.
Rgb radiated_power(const Light& light);

/// Returns why the light cannot be used; nothing if it can.
std::optional<std::string> fault_in(const Light& light);
/// Returns what fault_in() does, without looking into the light's web or map, which may be large and shared.
std::optional<std::string> fault_in_all_but_shared(const Light& light);

}  // namespace alvor
