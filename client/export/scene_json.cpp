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

/// Returns a whole number in [0, 2^32).
std::uint32_t whole_number(const json& source) {
  if (!source.is_number_unsigned() || source.get<std::uint64_t>() > std::numeric_limits<std::uint32_t>::max())
    throw SolutionFileError("one of its numbers is not a whole number below 2^32");
  return source.get<std::uint32_t>();
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
  json result{{"name", material.name},
              {"emission", json_of(material.emission)},
              {"reflectance", json_of(material.reflectance)},
              {"two_sided", material.two_sided}};
  if (!material.regular_transmittance.is_zero()) result["regular_transmittance"] = json_of(material.regular_transmittance);
  if (material.is_translucent()) result["diffuse_transmittance"] = json_of(material.diffuse_transmittance);
  return result;
}

Material material_of(const json& source, std::size_t number) {
  return naming("material ", number, [&]() -> Material {
    const auto share = [&](const char* name) { return source.contains(name) ? rgb_of(source[name]) : Rgb{}; };
    return {source.at("name").get<std::string>(), rgb_of(source.at("emission")),  rgb_of(source.at("reflectance")),
            source.at("two_sided").get<bool>(),   share("regular_transmittance"), std::nullopt,
            share("diffuse_transmittance")};
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

SceneObject object_of(const json& source, std::size_t number) {
  return naming("object ", number, [&] {
    SceneObject object;
    object.name = source.at("name").get<std::string>();
    object.first_face = whole_number(source.at("first_face"));
    object.face_count = whole_number(source.at("face_count"));
    if (source.contains("parent")) object.parent = whole_number(source["parent"]);
    if (source.contains("transform")) {
      const auto t = source["transform"].get<std::array<double, 12>>();
      object.placement = {{t[0], t[1], t[2]}, {t[3], t[4], t[5]}, {t[6], t[7], t[8]}, {t[9], t[10], t[11]}};
    }
    return object;
  });
}

template <class Item>
std::vector<json> json_of_all(std::span<const Item> items, std::size_t most_bytes) {
  std::vector<json> all;
  std::size_t bytes = 0;
  for (const Item& item : items) {
    all.push_back(json_of(item));
    bytes += all.back().dump(-1, ' ', true, json::error_handler_t::replace).size();
    if (bytes > most_bytes) return {};
  }
  return all;
}

template std::vector<json> json_of_all(std::span<const Material> items, std::size_t most_bytes);
template std::vector<json> json_of_all(std::span<const SceneObject> items, std::size_t most_bytes);

}  // namespace alvor
