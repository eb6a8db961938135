#include "client/export/light_json.h"

#include "client/export/solution_file.h"

#include <nlohmann/json.hpp>

#include <array>

namespace alvor {

namespace {

using nlohmann::json;

constexpr std::array kinds{"point", "spot", "directional"};

std::array<double, 3> numbers_of(const json& object, const char* key) { return object.at(key).get<std::array<double, 3>>(); }

Vec3 vector_of(const json& object, const char* key) {
  const auto [x, y, z] = numbers_of(object, key);
  return {x, y, z};
}

}  // namespace

json json_of(const Light& light) {
  const Vec3 &p = light.position, &d = light.direction;
  return {{"name", light.name},
          {"kind", kinds[static_cast<std::size_t>(light.kind)]},
          {"intensity", {light.intensity.r, light.intensity.g, light.intensity.b}},
          {"position", {p.x, p.y, p.z}},
          {"direction", {d.x, d.y, d.z}},
          {"inner_cone_radians", light.inner_cone},
          {"outer_cone_radians", light.outer_cone},
          {"radius_meters", light.radius},
          {"angular_diameter_radians", light.angular_diameter}};
}

Light light_of(const json& source, const std::string& place) {
  try {
    Light light;
    light.name = source.at("name").get<std::string>();
    const auto kind = std::ranges::find(kinds, source.at("kind").get<std::string>());
    if (kind == kinds.end()) throw SolutionFileError(place + ": its kind is not known");
    light.kind = static_cast<LightKind>(kind - kinds.begin());
    const auto [r, g, b] = numbers_of(source, "intensity");
    light.intensity = {r, g, b};
    light.position = vector_of(source, "position");
    light.direction = vector_of(source, "direction");
    light.inner_cone = source.at("inner_cone_radians").get<double>();
    light.outer_cone = source.at("outer_cone_radians").get<double>();
    light.radius = source.at("radius_meters").get<double>();
    light.angular_diameter = source.at("angular_diameter_radians").get<double>();
    if (const auto reason = fault_in(light)) throw SolutionFileError(place + ": " + *reason);
    return light;
  } catch (const json::exception&) {
    throw SolutionFileError(place + ": not a light as Alvor writes it");
  }
}

}  // namespace alvor
