#include "client/command/options/sky_options.h"

#include "client/command/output/failure.h"
#include "client/command/output/numbers.h"
#include "client/picture/units.h"
#include "meshing/sun_position.h"

#include <cmath>
#include <cstdio>
#include <ctime>
#include <numbers>

namespace alvor {

namespace {

constexpr double radians = std::numbers::pi / 180;
constexpr double diameter_of_sun = 0.533 * radians;
// Illuminance of an open horizontal surface by an overcast or uniform sky, if nothing is said: a bright cloudy day.
constexpr double overcast_lux = 10'000;

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
  char sign = '+';
  const bool is_utc = rest == "Z", has_offset = std::sscanf(rest.c_str(), "%1[+-]%2d:%2d", &sign, &hours, &minutes) == 3;
  const bool is_day = day.tm_mon >= 1 && day.tm_mon <= 12 && day.tm_mday >= 1 && day.tm_mday <= 31 && day.tm_hour < 24;
  if (fields != 5 || !is_day || !(is_utc || has_offset))
    refuse("--time: '" + text + "' is not like 2026-06-21T12:00Z or 2026-06-21T14:00+02:00");
  day.tm_year -= 1900, day.tm_mon -= 1, day.tm_sec = second;
  const int offset = 60 * (60 * hours + minutes);
  return static_cast<double>(timegm(&day)) - (sign == '-' ? -offset : offset);
}

std::vector<double> two_numbers(const std::string& option, const std::string& text, const char* what) {
  const auto numbers = parse_numbers(text, 2);
  if (!numbers) refuse(option + ": '" + text + "' is not " + what);
  return *numbers;
}

std::optional<SunPosition> position_of(const SkyOptions& options) {
  if (options.place.empty() != options.time.empty()) refuse("--place and --time belong together");
  if (!options.place.empty() && !options.sun.empty()) refuse("--sun says where the sun stands; --place and --time say it again");
  if (!options.place.empty()) {
    const auto place = two_numbers("--place", options.place, "LATITUDE,LONGITUDE");
    if (std::abs(place[0]) > 90 || std::abs(place[1]) > 180) refuse("--place: " + options.place + " is not on the Earth");
    return sun_position({place[0], place[1]}, seconds_of(options.time));
  }
  if (options.sun.empty()) return std::nullopt;
  const auto sun = two_numbers("--sun", options.sun, "AZIMUTH,ELEVATION");
  if (std::abs(sun[1]) > 90) refuse("--sun: an elevation is within [-90, 90] degrees");
  return SunPosition{sun[0], sun[1]};
}

/// The sky that was asked for: its distribution, and its light if the sky says it.
struct Sky {
  SkyDistribution distribution;
  std::optional<double> light;  // horizontal, unit of the scene
};

/// Makes the lights of one scene.
class SkyMaker {
 public:
  SkyMaker(const SkyOptions& options, double lumens_per_watt, Scene& scene)
      : options_(options),
        scene_(scene),
        of_lux_(scene.quantity == Quantity::photometric ? 1 : 1 / lumens_per_watt),
        of_watts_(of_lux_ * lumens_per_watt),
        up_(scene.up == UpAxis::y ? Vec3{0, 1, 0} : Vec3{0, 0, 1}),
        sun_(position_of(options)) {
    if (!sun_) return;
    to_sun_ = direction_of(*sun_);
    if (options.sky.starts_with("perez:")) direct_of_sky_ = of_watts_ * perez_light()[0];
  }

  void add(std::vector<std::string>& warnings) {
    const bool sun_shines = sun_ && sun_->elevation > 0;
    if (sun_ && !sun_shines) {
      char text[120];
      std::snprintf(text, sizeof text, "the sun is %.2f degrees below the horizon: it does not shine", -sun_->elevation);
      warnings.push_back(text);
    }
    if (options_.sun_light && !sun_) refuse("--sun-light needs --sun, or --place and --time");
    if (sun_shines) add_sun();
    if (!options_.sky.empty()) add_sky();
    else if (options_.sky_light) refuse("--sky-light needs --sky");
    if (options_.ground > 0) add_ground();
  }

 private:
  Vec3 direction_of(const SunPosition& sun) const {
    const double turn = (sun.azimuth + options_.north) * radians, h = sun.elevation * radians;
    const Vec3 north = scene_.up == UpAxis::y ? Vec3{0, 0, -1} : Vec3{0, 1, 0}, east{1, 0, 0};
    return std::cos(h) * (std::cos(turn) * north + std::sin(turn) * east) + std::sin(h) * up_;
  }
  Light& add_light(const char* name, LightKind kind, double intensity) {
    Light light;
    light.name = name;
    light.kind = kind;
    light.intensity = {intensity, intensity, intensity};
    scene_.lights.push_back(light);
    return scene_.lights.back();
  }
  void add_sun() {
    const double direct = direct_of_sky_ ? *direct_of_sky_ : of_lux_ * clear_sky(sun_->elevation).sun;
    Light& sun = add_light("sun", LightKind::directional, options_.sun_light.value_or(direct));
    sun.direction = -to_sun_;
    sun.angular_diameter = diameter_of_sun;
    horizontal_ += sun.intensity.g * std::sin(sun_->elevation * radians);
  }
  void add_sky() {
    const Sky made = make_sky();
    const double model = made.light ? *made.light : of_lux_ * overcast_lux;
    Light& sky = add_light("sky", LightKind::sky, options_.sky_light.value_or(model));
    sky.direction = -up_;
    sky.sky = made.distribution;
    horizontal_ += sky.intensity.g;
  }
  void add_ground() {
    if (horizontal_ == 0) refuse("--ground needs a sun or a sky that lights it");
    Light& ground = add_light("ground", LightKind::sky, options_.ground * horizontal_);
    ground.direction = up_;
  }
  Sky make_sky() const {
    const std::string& name = options_.sky;
    if (name == "uniform") return {};
    if (name == "overcast") return {{.g = 2}, {}};
    if (!sun_) refuse("--sky " + name + " needs the sun's place: --sun, or --place and --time");
    const double light = of_lux_ * clear_sky(std::max(0.0, sun_->elevation)).sky;
    const std::optional<double> if_clear = light > 0 ? std::optional(light) : std::nullopt;
    if (name == "clear") return {cie_sky(12, to_sun_), if_clear};
    if (name.starts_with("perez:")) return make_perez();
    const auto number = name.starts_with("cie") ? parse_numbers(name.substr(3), 1) : std::nullopt;
    if (!number || (*number)[0] != std::floor((*number)[0]) || (*number)[0] < 1 || (*number)[0] > 15)
      refuse("--sky: '" + name + "' is not uniform, overcast, clear, cie1 to cie15, or perez:DIRECT,DIFFUSE");
    const int which = static_cast<int>((*number)[0]);
    return {cie_sky(which, to_sun_), which >= 11 ? if_clear : std::nullopt};
  }
  std::vector<double> perez_light() const {
    const auto light = two_numbers("--sky perez", options_.sky.substr(6), "DIRECT,DIFFUSE in W/m2");
    if (light[0] < 0 || !(light[1] > 0)) refuse("--sky perez: needs direct >= 0 and diffuse > 0, in W/m2");
    return light;
  }
  Sky make_perez() const {
    const auto light = perez_light();
    return {perez_sky(light[0], light[1], (90 - sun_->elevation) * radians, to_sun_), of_watts_ * light[1]};
  }

  const SkyOptions& options_;
  Scene& scene_;
  const double of_lux_, of_watts_;  ///< the scene's unit per lx and per W/m2
  const Vec3 up_;
  const std::optional<SunPosition> sun_;
  Vec3 to_sun_{0, 1, 0};
  std::optional<double> direct_of_sky_;  ///< irradiance from the sun that the sky's model was given
  double horizontal_ = 0;                ///< irradiance of an open horizontal surface
};

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

void take_sky_options(const SkyOptions& options, double lumens_per_watt, Scene& scene, std::vector<std::string>& warnings) {
  SkyMaker(options, lumens_per_watt, scene).add(warnings);
}

}  // namespace alvor
