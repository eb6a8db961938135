#include "client/export/light_json.h"

#include "client/export/solution_file.h"
#include "client/picture/units.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace alvor {

namespace {

using nlohmann::json;

constexpr std::array kinds{"point", "spot", "directional", "luminaire", "sky", "environment"};
// Pixels of an environment map in a solution file, and decimal digits of its values: 150 to 220 KB.
constexpr std::uint32_t most_columns = 128, most_rows = 64;
constexpr int digits = 4;

/// Returns the number of `name` in a list of names. Throws SolutionFileError.
template <class Value>
Value value_named(const auto& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) throw SolutionFileError("'" + name + "' is not known");
  return static_cast<Value>(found - names.begin());
}

std::array<double, 3> numbers_of(const json& object, const char* key) { return object.at(key).get<std::array<double, 3>>(); }

Vec3 vector_of(const json& object, const char* key) {
  const auto [x, y, z] = numbers_of(object, key);
  return {x, y, z};
}

json json_of_web(const PhotometricWeb& web) {
  return {{"axis", web.axis == PhotometricWeb::Axis::across ? "across" : "aim"},
          {"plane_degrees", web.planes},
          {"angle_degrees", web.angles},
          {"intensities", web.intensities}};
}

std::shared_ptr<const PhotometricWeb> web_of(const json& source) {
  auto web = std::make_shared<PhotometricWeb>();
  web->axis = source.at("axis") == "across" ? PhotometricWeb::Axis::across : PhotometricWeb::Axis::aim;
  source.at("plane_degrees").get_to(web->planes);
  source.at("angle_degrees").get_to(web->angles);
  source.at("intensities").get_to(web->intensities);
  return web;
}

json json_of_sky(const SkyDistribution& sky) {
  return {{"coefficients", {sky.a, sky.b, sky.c, sky.d, sky.e, sky.g}}, {"to_sun", {sky.to_sun.x, sky.to_sun.y, sky.to_sun.z}}};
}

SkyDistribution sky_of(const json& source) {
  const auto [a, b, c, d, e, g] = source.at("coefficients").get<std::array<double, 6>>();
  return {a, b, c, d, e, g, vector_of(source, "to_sun")};
}

/// Writes to `object` the web or the map that light `which` points to. Several lights may point to one: the first of them writes
/// it under `key`, and the others write the number of that first light under `key` + "_of".
template <class Shared>
void add_shared(std::span<const Light> lights, std::size_t which, std::shared_ptr<const Shared> Light::*member, const char* key,
                json (*json_of)(const Shared&), json& object) {
  const auto& shared = lights[which].*member;
  const auto first = std::ranges::find(lights, shared, member) - lights.begin();
  if (static_cast<std::size_t>(first) < which) object[std::string(key) + "_of"] = first;
  else object[key] = json_of(*shared);
}

/// Returns the web or the map that add_shared() wrote, with `source` itself or with one of the lights `before`.
template <class Shared>
std::shared_ptr<const Shared> read_shared(const json& source, std::span<const Light> before,
                                          std::shared_ptr<const Shared> Light::*member, const char* key,
                                          std::shared_ptr<const Shared> (*read)(const json&)) {
  const std::string reference = std::string(key) + "_of";
  if (!source.contains(reference)) return read(source.at(key));
  const auto which = source.at(reference).get<std::size_t>();
  if (which >= before.size()) throw SolutionFileError("its " + std::string(key) + " is not that of an earlier light");
  return before[which].*member;
}

void add_luminaire(std::span<const Light> lights, std::size_t which, json& object) {
  const Light& light = lights[which];
  const LuminousOpening& opening = light.opening;
  object["across"] = {light.across.x, light.across.y, light.across.z};
  object["opening"] = {{"shape", name_of(opening.shape)},
                       {"across_meters", opening.across},
                       {"along_meters", opening.along},
                       {"height_meters", opening.height}};
  if (light.electrical_watts > 0) object["electrical_watts"] = light.electrical_watts;
  add_shared(lights, which, &Light::web, "web", json_of_web, object);
}

void read_luminaire_fields(const json& source, std::span<const Light> before, Light& light) {
  light.across = vector_of(source, "across");
  const json& opening = source.at("opening");
  light.opening = {value_named<LuminousOpening::Shape>(names_of_shapes, opening.at("shape")), opening.at("across_meters"),
                   opening.at("along_meters"), opening.at("height_meters")};
  light.electrical_watts = source.value("electrical_watts", 0.0);
  light.web = read_shared(source, before, &Light::web, "web", web_of);
}

json json_of_environment(const EnvironmentMap& given) {
  const EnvironmentMap map = reduced(given, most_columns, most_rows);
  json radiance = json::array();
  for (const RgbF& pixel : map.pixels)
    for (const double band : {pixel.r, pixel.g, pixel.b}) {
      char text[32];
      std::snprintf(text, sizeof text, "%.*g", digits, band);
      radiance.push_back(std::strtod(text, nullptr));
    }
  return {{"columns", map.grid.columns}, {"rows", map.grid.rows}, {"radiance", std::move(radiance)}};
}

std::shared_ptr<const EnvironmentMap> environment_of(const json& source) {
  auto map = std::make_shared<EnvironmentMap>();
  map->grid = {source.at("columns").get<std::uint32_t>(), source.at("rows").get<std::uint32_t>()};
  const auto radiance = source.at("radiance").get<std::vector<float>>();
  if (radiance.size() % 3 != 0) throw SolutionFileError("its environment map has not three values per pixel");
  for (std::size_t n = 0; n < radiance.size(); n += 3) map->pixels.push_back({radiance[n], radiance[n + 1], radiance[n + 2]});
  return map;
}

void add_environment(std::span<const Light> lights, std::size_t which, json& object) {
  const Light& light = lights[which];
  object["across"] = {light.across.x, light.across.y, light.across.z};
  add_shared(lights, which, &Light::environment, "environment", json_of_environment, object);
}

void read_environment_fields(const json& source, std::span<const Light> before, Light& light) {
  light.across = vector_of(source, "across");
  light.environment = read_shared(source, before, &Light::environment, "environment", environment_of);
}

}  // namespace

json json_of(std::span<const Light> lights, std::size_t which) {
  const Light& light = lights[which];
  const Vec3 &p = light.position, &d = light.direction;
  json object{{"name", light.name},
              {"kind", kinds[static_cast<std::size_t>(light.kind)]},
              {"intensity", {light.intensity.r, light.intensity.g, light.intensity.b}},
              {"position", {p.x, p.y, p.z}},
              {"direction", {d.x, d.y, d.z}},
              {"inner_cone_radians", light.inner_cone},
              {"outer_cone_radians", light.outer_cone},
              {"radius_meters", light.radius},
              {"angular_diameter_radians", light.angular_diameter}};
  if (light.kind == LightKind::luminaire) add_luminaire(lights, which, object);
  if (light.kind == LightKind::sky) object["sky"] = json_of_sky(light.sky);
  if (light.kind == LightKind::environment) add_environment(lights, which, object);
  return object;
}

Light light_of(const json& source, std::span<const Light> before) {
  const std::string place = "light " + std::to_string(before.size());
  try {
    Light light;
    light.name = source.at("name").get<std::string>();
    light.kind = value_named<LightKind>(kinds, source.at("kind"));
    const auto [r, g, b] = numbers_of(source, "intensity");
    light.intensity = {r, g, b};
    light.position = vector_of(source, "position");
    light.direction = vector_of(source, "direction");
    light.inner_cone = source.at("inner_cone_radians").get<double>();
    light.outer_cone = source.at("outer_cone_radians").get<double>();
    light.radius = source.at("radius_meters").get<double>();
    light.angular_diameter = source.at("angular_diameter_radians").get<double>();
    if (light.kind == LightKind::luminaire) read_luminaire_fields(source, before, light);
    if (light.kind == LightKind::sky) light.sky = sky_of(source.at("sky"));
    if (light.kind == LightKind::environment) read_environment_fields(source, before, light);
    const bool is_shared = source.contains("web_of") || source.contains("environment_of");
    if (const auto reason = is_shared ? fault_in_all_but_shared(light) : fault_in(light)) throw SolutionFileError(*reason);
    return light;
  } catch (const json::exception&) {
    throw SolutionFileError(place + ": not a light as Alvor writes it");
  } catch (const SolutionFileError& error) {
    throw SolutionFileError(place + ": " + error.what());
  }
}

}  // namespace alvor
