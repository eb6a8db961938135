#include "meshing/daylight.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace alvor {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double diameter_of_sun = 0.533 * degree;
// Illuminance of an open horizontal surface by a sky that has no model of its own: a bright cloudy day.
constexpr double cloudy_lux = 10'000;
// Number of the first of the CIE skies that are clear.
constexpr int first_clear = 11;
// W/m2 or lx: a sun that brings less is no light. At the horizon the model has suns of 1e-40 lx.
constexpr double least_of_model = 1e-6;

bool is_in(double value, double low, double high) { return value >= low && value <= high; }

std::string out_of_range(const char* what) { return std::string("its ") + what + " is out of range"; }

std::optional<std::string> fault_of_sun(const Daylight& wanted) {
  if (const auto* stands = std::get_if<SunPosition>(&wanted.sun)) {
    if (!is_in(stands->azimuth, -360, 360)) return out_of_range("azimuth of the sun");
    if (!is_in(stands->elevation, -90, 90)) return out_of_range("elevation of the sun");
  } else if (const auto* seen = std::get_if<SunTime>(&wanted.sun)) {
    constexpr double first_second = -2'208'988'800, last_second = 4'102'444'800;  // of 1900 and 2100
    if (!is_in(seen->place.latitude, -90, 90)) return out_of_range("latitude");
    if (!is_in(seen->place.longitude, -180, 180)) return out_of_range("longitude");
    if (!is_in(seen->unix_seconds, first_second, last_second)) return out_of_range("time");
  }
  return std::nullopt;
}

/// Makes the lights of one scene.
class DaylightMaker {
 public:
  DaylightMaker(const Daylight& wanted, Quantity quantity, UpAxis up, double lumens_per_watt)
      : daylight_(wanted),
        of_lux_(quantity == Quantity::photometric ? 1 : 1 / lumens_per_watt),
        of_watts_(of_lux_ * lumens_per_watt),
        up_(up == UpAxis::y ? Vec3{0, 1, 0} : Vec3{0, 0, 1}),
        sun_(position_of_sun(wanted)),
        to_sun_(sun_ ? direction_of_sun(up) : up_) {}

  std::vector<Light> make() {
    if (sun_ && sun_->elevation > 0 && irradiance_of_sun() >= least_of_model) add_sun();
    if (daylight_.sky != Daylight::Sky::none) add_sky();
    if (const double ground = daylight_.ground_reflectance * horizontal_; ground > 0)
      add_light("ground", LightKind::sky, ground).direction = up_;
    return std::move(lights_);
  }

 private:
  Vec3 direction_of_sun(UpAxis up) const {
    const double turn = (sun_->azimuth + daylight_.north_degrees) * degree, h = elevation();
    const Vec3 north = up == UpAxis::y ? Vec3{0, 0, -1} : Vec3{0, 1, 0}, east{1, 0, 0};
    return std::cos(h) * (std::cos(turn) * north + std::sin(turn) * east) + std::sin(h) * up_;
  }
  double elevation() const { return sun_->elevation * degree; }
  ClearSky clear() const { return clear_sky(sun_->elevation); }

  Light& add_light(const char* name, LightKind kind, double intensity) {
    Light& light = lights_.emplace_back();
    light.name = name;
    light.kind = kind;
    light.intensity = {intensity, intensity, intensity};
    return light;
  }
  double irradiance_of_sun() const {
    const bool is_perez = daylight_.sky == Daylight::Sky::perez;
    const double by_model = is_perez ? of_watts_ * daylight_.direct_normal_watts : of_lux_ * clear().sun;
    return daylight_.sun_irradiance.value_or(by_model);
  }
  void add_sun() {
    Light& sun = add_light("sun", LightKind::directional, irradiance_of_sun());
    sun.direction = -to_sun_;
    sun.angular_diameter = diameter_of_sun;
    horizontal_ += sun.intensity.g * std::sin(elevation());
  }
  void add_sky() {
    const double irradiance = daylight_.sky_irradiance ? *daylight_.sky_irradiance : sky_by_model();
    Light& sky = add_light("sky", LightKind::sky, irradiance);
    sky.direction = -up_;
    sky.sky = distribution();
    horizontal_ += irradiance;
  }
  double sky_by_model() const {
    if (daylight_.sky == Daylight::Sky::perez) return of_watts_ * daylight_.diffuse_horizontal_watts;
    const bool is_clear = daylight_.sky == Daylight::Sky::cie && daylight_.cie_number >= first_clear;
    return of_lux_ * (is_clear ? clear().sky : cloudy_lux);
  }
  SkyDistribution distribution() const {
    switch (daylight_.sky) {
      case Daylight::Sky::overcast: return {.g = 2};
      case Daylight::Sky::cie: return cie_sky(daylight_.cie_number, to_sun_);
      case Daylight::Sky::perez:
        return perez_sky(daylight_.direct_normal_watts, daylight_.diffuse_horizontal_watts, std::numbers::pi / 2 - elevation(),
                         to_sun_);
      default: return {};
    }
  }

  const Daylight& daylight_;
  const double of_lux_, of_watts_;  ///< the scene's unit per lx and per W/m2
  const Vec3 up_;
  const std::optional<SunPosition> sun_;
  const Vec3 to_sun_;
  double horizontal_ = 0;  ///< irradiance of an open horizontal surface
  std::vector<Light> lights_;
};

}  // namespace

std::optional<SunPosition> position_of_sun(const Daylight& wanted) {
  if (const auto* stands = std::get_if<SunPosition>(&wanted.sun)) return *stands;
  const auto* seen = std::get_if<SunTime>(&wanted.sun);
  return seen ? std::optional(sun_position(seen->place, seen->unix_seconds)) : std::nullopt;
}

std::optional<std::string> fault_in(const Daylight& wanted) {
  using Sky = Daylight::Sky;
  constexpr double most_irradiance = 1e12, most_watts = 1e6;
  if (auto fault = fault_of_sun(wanted)) return fault;
  if (!is_in(wanted.sun_irradiance.value_or(0), 0, most_irradiance)) return out_of_range("irradiance from the sun");
  if (!is_in(wanted.sky_irradiance.value_or(0), 0, most_irradiance)) return out_of_range("irradiance from the sky");
  if (!is_in(wanted.direct_normal_watts, 0, most_watts)) return out_of_range("direct normal irradiance");
  if (!is_in(wanted.diffuse_horizontal_watts, 0, most_watts)) return out_of_range("diffuse horizontal irradiance");
  if (!is_in(wanted.ground_reflectance, 0, 1)) return out_of_range("reflectance of the ground");
  if (!is_in(wanted.north_degrees, -360, 360)) return out_of_range("direction of north");
  if (wanted.sky == Sky::cie && !is_in(wanted.cie_number, 1, 15)) return out_of_range("number of a CIE sky");
  if (wanted.sky == Sky::perez && wanted.diffuse_horizontal_watts == 0)
    return "the sky of Perez needs a diffuse horizontal irradiance";
  const bool needs_sun = wanted.sky == Sky::cie || wanted.sky == Sky::perez || wanted.sun_irradiance;
  const bool has_sun = !std::holds_alternative<std::monostate>(wanted.sun);
  if (needs_sun && !has_sun) return "it is not said where the sun stands";
  if (wanted.sky_irradiance && wanted.sky == Sky::none) return "has an irradiance from a sky, but no sky";
  if (wanted.ground_reflectance > 0 && !has_sun && wanted.sky == Sky::none)
    return "the ground needs a sun or a sky that lights it";
  return std::nullopt;
}

std::vector<Light> lights_of(const Daylight& wanted, Quantity quantity, UpAxis up, double lumens_per_watt) {
  return DaylightMaker(wanted, quantity, up, lumens_per_watt).make();
}

}  // namespace alvor
