#include "import/formats/daylight.h"

#include "import/base/import_error.h"
#include "meshing/sun_position.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

namespace alvor {

namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double diameter_of_sun = 0.533 * radians;
// Illuminance of an open horizontal surface by a sky that has no model of its own: a bright cloudy day.
constexpr double cloudy_lux = 10'000;
// Number of the first of the CIE skies that are clear.
constexpr std::uint32_t first_clear = 11;

[[noreturn]] void refuse(const std::string& reason) { throw ImportError("daylight", reason); }

void require_in(double value, double low, double high, const char* what) {
  if (!(value >= low && value <= high)) refuse(std::string("its ") + what + " is out of range");
}

void refuse_out_of_range(const v1::Daylight& wanted) {
  require_in(wanted.sun_azimuth_degrees(), -360, 360, "azimuth of the sun");
  require_in(wanted.sun_elevation_degrees(), -90, 90, "elevation of the sun");
  require_in(wanted.sun_irradiance(), 0, 1e12, "irradiance from the sun");
  require_in(wanted.sky_irradiance(), 0, 1e12, "irradiance from the sky");
  require_in(wanted.direct_normal_watts(), 0, 1e6, "direct normal irradiance");
  require_in(wanted.diffuse_horizontal_watts(), 0, 1e6, "diffuse horizontal irradiance");
  require_in(wanted.ground_reflectance(), 0, 1, "reflectance of the ground");
  require_in(wanted.north_degrees(), -360, 360, "direction of north");
  if (wanted.sky() == v1::Daylight::CIE) require_in(wanted.cie_number(), 1, 15, "number of a CIE sky");
  if (wanted.sky() == v1::Daylight::PEREZ && wanted.diffuse_horizontal_watts() == 0)
    refuse("the sky of Perez needs a diffuse horizontal irradiance");
  if (!v1::Daylight::Sky_IsValid(wanted.sky())) refuse("its sky is not known");
  const bool needs_sun = wanted.sky() == v1::Daylight::CIE || wanted.sky() == v1::Daylight::PEREZ;
  if (!wanted.has_sun_azimuth_degrees() && (needs_sun || wanted.has_sun_irradiance()))
    refuse("it is not said where the sun stands");
  if (wanted.has_sky_irradiance() && wanted.sky() == v1::Daylight::SKY_UNSPECIFIED)
    refuse("has an irradiance from a sky, but no sky");
}

/// Makes the lights of one scene.
class DaylightMaker {
 public:
  DaylightMaker(const v1::Daylight& wanted, double lumens_per_watt, Scene& scene)
      : daylight_(wanted),
        scene_(scene),
        of_lux_(scene.quantity == Quantity::photometric ? 1 : 1 / lumens_per_watt),
        of_watts_(of_lux_ * lumens_per_watt),
        up_(scene.up == UpAxis::y ? Vec3{0, 1, 0} : Vec3{0, 0, 1}),
        to_sun_(direction_of_sun()) {}

  void add(std::vector<std::string>& warnings) {
    if (daylight_.has_sun_azimuth_degrees()) add_sun(warnings);
    if (daylight_.sky() != v1::Daylight::SKY_UNSPECIFIED) add_sky();
    if (daylight_.ground_reflectance() > 0) add_ground();
  }

 private:
  Vec3 direction_of_sun() const {
    const double turn = (daylight_.sun_azimuth_degrees() + daylight_.north_degrees()) * radians, h = elevation();
    const Vec3 north = scene_.up == UpAxis::y ? Vec3{0, 0, -1} : Vec3{0, 1, 0}, east{1, 0, 0};
    return std::cos(h) * (std::cos(turn) * north + std::sin(turn) * east) + std::sin(h) * up_;
  }
  double elevation() const { return daylight_.sun_elevation_degrees() * radians; }
  ClearSky clear() const { return clear_sky(daylight_.sun_elevation_degrees()); }

  Light& add_light(const char* name, LightKind kind, double intensity) {
    Light light;
    light.name = name;
    light.kind = kind;
    light.intensity = {intensity, intensity, intensity};
    scene_.lights.push_back(light);
    return scene_.lights.back();
  }
  void add_sun(std::vector<std::string>& warnings) {
    if (daylight_.sun_elevation_degrees() <= 0) {
      char text[120];
      std::snprintf(text, sizeof text, "the sun is %.2f degrees below the horizon: it does not shine",
                    -daylight_.sun_elevation_degrees());
      warnings.push_back(text);
      return;
    }
    const bool is_perez = daylight_.sky() == v1::Daylight::PEREZ;
    const double by_model = is_perez ? of_watts_ * daylight_.direct_normal_watts() : of_lux_ * clear().sun;
    Light& sun = add_light("sun", LightKind::directional, daylight_.has_sun_irradiance() ? daylight_.sun_irradiance() : by_model);
    sun.direction = -to_sun_;
    sun.angular_diameter = diameter_of_sun;
    horizontal_ += sun.intensity.g * std::sin(elevation());
  }
  void add_sky() {
    Light& sky = add_light("sky", LightKind::sky, daylight_.has_sky_irradiance() ? daylight_.sky_irradiance() : sky_by_model());
    sky.direction = -up_;
    sky.sky = distribution();
    horizontal_ += sky.intensity.g;
  }
  void add_ground() {
    if (horizontal_ == 0) refuse("the ground needs a sun or a sky that lights it");
    add_light("ground", LightKind::sky, daylight_.ground_reflectance() * horizontal_).direction = up_;
  }
  double sky_by_model() const {
    if (daylight_.sky() == v1::Daylight::PEREZ) return of_watts_ * daylight_.diffuse_horizontal_watts();
    const bool is_clear = daylight_.sky() == v1::Daylight::CIE && daylight_.cie_number() >= first_clear;
    return of_lux_ * (is_clear ? clear().sky : cloudy_lux);
  }
  SkyDistribution distribution() const {
    switch (daylight_.sky()) {
      case v1::Daylight::OVERCAST: return {.g = 2};
      case v1::Daylight::CIE: return cie_sky(static_cast<int>(daylight_.cie_number()), to_sun_);
      case v1::Daylight::PEREZ:
        return perez_sky(daylight_.direct_normal_watts(), daylight_.diffuse_horizontal_watts(),
                         std::numbers::pi / 2 - elevation(), to_sun_);
      default: return {};
    }
  }

  const v1::Daylight& daylight_;
  Scene& scene_;
  const double of_lux_, of_watts_;  ///< the scene's unit per lx and per W/m2
  const Vec3 up_, to_sun_;
  double horizontal_ = 0;  ///< irradiance of an open horizontal surface
};

}  // namespace

void add_daylight(const v1::Daylight& wanted, double lumens_per_watt, Scene& scene, std::vector<std::string>& warnings) {
  refuse_out_of_range(wanted);
  DaylightMaker(wanted, lumens_per_watt, scene).add(warnings);
}

}  // namespace alvor
