#include "client/export/scene_json.h"

#include "client/export/solution_file.h"

#include <nlohmann/json.hpp>

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace alvor {

namespace {

using nlohmann::json;

json json_of(const Rgb& bands) { return {bands.r, bands.g, bands.b}; }

Rgb rgb_of(const json& source) {
  const auto [r, g, b] = source.get<std::array<double, 3>>();
  if (!(r >= 0 && g >= 0 && b >= 0)) throw SolutionFileError("a band of it is negative");
  return {r, g, b};
}

/// Returns the result of `read`. Its errors become SolutionFileError that begin with the place.
template <class Read>
auto naming(const char* kind, std::size_t number, Read read) {
  const std::string place = kind + std::to_string(number);
  try {
    return read();
  } catch (const json::exception&) {
    throw SolutionFileError(place + ": not as Alvor writes it");
  } catch (const SolutionFileError& error) {
    throw SolutionFileError(place + ": " + error.what());
  }
}

}  // namespace

json json_of(const Material& material) {
  return {{"name", material.name},
          {"emission", json_of(material.emission)},
          {"reflectance", json_of(material.reflectance)},
          {"two_sided", material.two_sided}};
}

Material material_of(const json& source, std::size_t number) {
  return naming("material ", number, [&]() -> Material {
    return {source.at("name").get<std::string>(), rgb_of(source.at("emission")), rgb_of(source.at("reflectance")),
            source.at("two_sided").get<bool>()};
  });
}

json json_of(const SceneObject& object) {
  json result{{"name", object.name}, {"first_face", object.first_face}, {"face_count", object.face_count}};
  if (object.parent) result["parent"] = *object.parent;
  const Placement& placement = object.placement;
  if (placement != Placement{})
    for (const Vec3& part : {placement.x, placement.y, placement.z, placement.origin})
      for (const double number : {part.x, part.y, part.z}) result["transform"].push_back(number);
  return result;
}

SceneObject object_of(const json& source, std::span<const SceneObject> before) {
  return naming("object ", before.size(), [&] {
    SceneObject object;
    object.name = source.at("name").get<std::string>();
    object.first_face = source.at("first_face").get<std::uint32_t>();
    object.face_count = source.at("face_count").get<std::uint32_t>();
    if (source.contains("parent")) object.parent = source["parent"].get<std::uint32_t>();
    if (source.contains("transform")) {
      const auto t = source["transform"].get<std::array<double, 12>>();
      object.placement = {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}, {t[9], t[10], t[11]}};
    }
    if (object.parent && *object.parent >= before.size()) throw SolutionFileError("its parent does not come before it");
    return object;
  });
}

}  // namespace alvor
