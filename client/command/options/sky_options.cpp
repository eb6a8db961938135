#include "client/command/options/sky_options.h"

#include "client/command/output/failure.h"
#include "client/command/output/numbers.h"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <vector>

namespace alvor {

namespace {

// The CIE sky that is called clear: number 12, a low-turbidity clear sky (ISO 15469).
constexpr std::uint32_t clear_sky_number = 12;

[[noreturn]] void refuse(const std::string& reason) { throw Failure(ExitStatus::usage, reason); }

/// Returns seconds since 1970 of "2026-06-21T12:00:00Z" or "2026-06-21T14:00+02:00".
double seconds_of(const std::string& text) {
  std::tm day{};
  int read = 0;
  const int fields = std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d%n", &day.tm_year, &day.tm_mon, &day.tm_mday, &day.tm_hour,
                                 &day.tm_min, &read);
  std::string rest = fields == 5 ? text.substr(static_cast<std::size_t>(read)) : "";
  int second = 0, length = 0;
  if (std::sscanf(rest.c_str(), ":%2d%n", &second, &length) == 1) rest.erase(0, static_cast<std::size_t>(length));
  int hours = 0, minutes = 0;
  char sign[2] = "+";
  int end = 0;
  const bool has_offset = std::sscanf(rest.c_str(), "%1[+-]%2d:%2d%n", sign, &hours, &minutes, &end) == 3 &&
                          static_cast<std::size_t>(end) == rest.size() && hours <= 14 && minutes < 60 && hours >= 0 &&
                          minutes >= 0;
  const auto is_in = [](int value, int low, int high) { return value >= low && value <= high; };
  const bool is_time = is_in(day.tm_mon, 1, 12) && is_in(day.tm_mday, 1, 31) && is_in(day.tm_hour, 0, 23) &&
                       is_in(day.tm_min, 0, 59) && is_in(second, 0, 59);
  if (fields != 5 || !is_time || !(rest == "Z" || has_offset))
    refuse("--time: '" + text + "' is not like 2026-06-21T12:00Z or 2026-06-21T14:00+02:00");
  day.tm_year -= 1900, day.tm_mon -= 1, day.tm_sec = second;
  const int month_day = day.tm_mday, offset = 60 * (60 * hours + minutes);
  const auto seconds = static_cast<double>(timegm(&day));  // changes a day that its month does not have
  if (day.tm_mday != month_day) refuse("--time: '" + text + "' is a day that its month does not have");
  return seconds - (sign[0] == '-' ? -offset : offset);
}

std::vector<double> two_numbers(const std::string& option, const std::string& text, const char* what) {
  const auto numbers = parse_numbers(text, 2);
  if (!numbers) refuse(option + ": '" + text + "' is not " + what);
  return *numbers;
}

/// Sets where the sun stands, if the options say so.
void set_sun(const SkyOptions& options, v1::Daylight& wanted) {
  if (options.place.empty() != options.time.empty()) refuse("--place and --time belong together");
  if (!options.place.empty() && !options.sun.empty()) refuse("--sun says where the sun stands; --place and --time say it again");
  if (!options.place.empty()) {
    const auto place = two_numbers("--place", options.place, "LATITUDE,LONGITUDE");
    if (std::abs(place[0]) > 90 || std::abs(place[1]) > 180) refuse("--place: " + options.place + " is not on the Earth");
    v1::SunTime& seen = *wanted.mutable_sun_time();
    seen.set_latitude_degrees(place[0]);
    seen.set_longitude_degrees(place[1]);
    seen.mutable_time()->set_seconds(static_cast<std::int64_t>(seconds_of(options.time)));
  }
  if (options.sun.empty()) return;
  const auto sun = two_numbers("--sun", options.sun, "AZIMUTH,ELEVATION");
  if (std::abs(sun[1]) > 90) refuse("--sun: an elevation is within [-90, 90] degrees");
  wanted.set_sun_azimuth_degrees(std::fmod(sun[0], 360));
  wanted.set_sun_elevation_degrees(sun[1]);
}

bool has_sun(const v1::Daylight& wanted) { return wanted.has_sun_azimuth_degrees() || wanted.has_sun_time(); }

void set_perez(const std::string& text, v1::Daylight& wanted) {
  const auto light = two_numbers("--sky perez", text, "DIRECT,DIFFUSE in W/m2");
  if (light[0] < 0 || !(light[1] > 0)) refuse("--sky perez: needs direct >= 0 and diffuse > 0, in W/m2");
  wanted.set_sky(v1::Daylight::PEREZ);
  wanted.set_direct_normal_watts(light[0]);
  wanted.set_diffuse_horizontal_watts(light[1]);
}

void set_cie(const std::string& name, v1::Daylight& wanted) {
  const auto number = name.starts_with("cie") ? parse_numbers(name.substr(3), 1) : std::nullopt;
  const bool is_known = number && (*number)[0] == std::floor((*number)[0]) && (*number)[0] >= 1 && (*number)[0] <= 15;
  if (!is_known && name != "clear")
    refuse("--sky: '" + name + "' is not uniform, overcast, clear, cie1 to cie15, or perez:DIRECT,DIFFUSE");
  wanted.set_sky(v1::Daylight::CIE);
  wanted.set_cie_number(is_known ? static_cast<std::uint32_t>((*number)[0]) : clear_sky_number);
}

void set_sky(const std::string& name, v1::Daylight& wanted) {
  if (name == "uniform") return wanted.set_sky(v1::Daylight::UNIFORM);
  if (name == "overcast") return wanted.set_sky(v1::Daylight::OVERCAST);
  if (name.starts_with("perez:")) set_perez(name.substr(6), wanted);
  else set_cie(name, wanted);
  if (!has_sun(wanted)) refuse("--sky " + name + " needs the sun's place: --sun, or --place and --time");
}

}  // namespace

void add_sky_options(CLI::App& command, SkyOptions& options) {
  command.add_option("--sun", options.sun, "Let the sun shine: azimuth (degrees clockwise from north), elevation")
      ->type_name("AZIMUTH,ELEVATION");
  command.add_option("--place", options.place, "Let the sun shine as on this place (degrees north, degrees east) at --time")
      ->type_name("LATITUDE,LONGITUDE");
  command.add_option("--time", options.time, "Time for --place: 2026-06-21T12:00Z, or with an offset instead of Z")
      ->type_name("TIME");
  command
      .add_option("--sun-light", options.sun_light,
                  "Irradiance of a surface that faces the sun, W/m2 or lx (by a model of the clear sky)")
      ->check(CLI::Range(0.0, 1e12));
  command
      .add_option("--sky", options.sky,
                  "Sky: uniform, overcast, clear, cie1 to cie15 (ISO 15469), or perez:DIRECT,DIFFUSE (irradiances in W/m2)")
      ->type_name("SKY");
  command
      .add_option("--sky-light", options.sky_light,
                  "Irradiance of an open horizontal surface from the sky alone, W/m2 or lx (by a model of the clear sky; "
                  "10000 lx for other skies)")
      ->check(CLI::Range(0.0, 1e12));
  command.add_option("--ground", options.ground, "Reflectance of a ground beyond the scene, which shines back (0)")
      ->check(CLI::Range(0.0, 1.0));
  command.add_option("--north", options.north, "Degrees, clockwise seen from above, from -z (z up: from y) to north (0)")
      ->check(CLI::Range(-360.0, 360.0));
}

std::optional<v1::Daylight> daylight_of(const SkyOptions& options) {
  v1::Daylight wanted;
  set_sun(options, wanted);
  if (options.sun_light && !has_sun(wanted)) refuse("--sun-light needs --sun, or --place and --time");
  if (options.sky_light && options.sky.empty()) refuse("--sky-light needs --sky");
  if (options.sun_light) wanted.set_sun_irradiance(*options.sun_light);
  if (options.sky_light) wanted.set_sky_irradiance(*options.sky_light);
  if (!options.sky.empty()) set_sky(options.sky, wanted);
  wanted.set_ground_reflectance(options.ground);
  wanted.set_north_degrees(options.north);
  if (!has_sun(wanted) && options.sky.empty()) {
    if (options.ground > 0) refuse("--ground needs a sun or a sky that lights it");
    return std::nullopt;
  }
  return wanted;
}

}  // namespace alvor
