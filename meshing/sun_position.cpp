#include "meshing/sun_position.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double seconds_of_day = 86400;
constexpr double days_from_1970_to_2000 = 10957.5;  // to noon of 2000-01-01, the epoch J2000

/// Returns an angle in [0, 360).
double in_full_turn(double degrees) {
  degrees = std::fmod(degrees, 360);
  return degrees < 0 ? degrees + 360 : degrees;
}

}  // namespace

SunPosition sun_position(const Geolocation& place, double unix_seconds) {
  const double days = unix_seconds / seconds_of_day - days_from_1970_to_2000;
  const double mean_longitude = in_full_turn(280.460 + 0.9856474 * days);
  const double mean_anomaly = in_full_turn(357.528 + 0.9856003 * days) * radians;
  const double ecliptic_longitude =
      in_full_turn(mean_longitude + 1.915 * std::sin(mean_anomaly) + 0.020 * std::sin(2 * mean_anomaly)) * radians;
  const double obliquity = (23.439 - 0.0000004 * days) * radians;
  const double right_ascension =
      std::atan2(std::cos(obliquity) * std::sin(ecliptic_longitude), std::cos(ecliptic_longitude)) / radians;
  const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic_longitude));
  const double hours = std::fmod(unix_seconds, seconds_of_day) / 3600;
  const double sidereal = 6.697375 + 0.0657098242 * days + hours;  // hours at Greenwich
  const double hour_angle = (15 * sidereal + place.longitude - right_ascension) * radians, latitude = place.latitude * radians;
  const double sine =
      std::sin(declination) * std::sin(latitude) + std::cos(declination) * std::cos(latitude) * std::cos(hour_angle);
  // East and north parts of the direction to the sun.
  const double east = -std::cos(declination) * std::sin(hour_angle);
  const double north =
      std::sin(declination) * std::cos(latitude) - std::cos(declination) * std::sin(latitude) * std::cos(hour_angle);
  return {in_full_turn(std::atan2(east, north) / radians), std::asin(std::clamp(sine, -1.0, 1.0)) / radians};
}

ClearSky clear_sky(double elevation) {
  const double sine = std::sin(elevation * radians);
  if (!(sine > 0)) return {};
  return {127'500 * std::exp(-0.21 / sine), 800 + 15'500 * std::sqrt(sine)};
}

}  // namespace alvor
