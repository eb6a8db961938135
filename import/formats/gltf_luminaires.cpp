#include "import/formats/gltf_luminaires.h"

#include "import/base/import_error.h"
#include "import/formats/gltf_accessor.h"
#include "import/formats/named_file.h"

#include <cmath>

namespace alvor {

namespace {

constexpr const char* extension_name = "EXT_lights_ies";

/// Returns an index; -1 if there is none that an int holds.
int index_in(const tinygltf::Value& object, const char* name) {
  const double index = number_in(object, name, -1);
  return index >= 0 && index < 1e9 ? static_cast<int>(index) : -1;
}

Rgb colour_in(const tinygltf::Value& object) {
  if (!object.IsObject() || !object.Has("color")) return {1, 1, 1};
  const tinygltf::Value& colour = object.Get("color");
  if (!colour.IsArray() || colour.ArrayLen() != 3) return {1, 1, 1};
  const auto band = [&](int n) { return colour.Get(n).IsNumber() ? colour.Get(n).GetNumberAsDouble() : 1; };
  return {band(0), band(1), band(2)};
}

std::string decoded_data(const std::string& uri, const std::string& place) {
  const auto comma = uri.find(";base64,");
  std::vector<unsigned char> bytes;
  std::string type;
  // tinygltf decodes only the media types of buffers and images.
  const std::string known = comma == uri.npos ? "" : "data:application/octet-stream" + uri.substr(comma);
  if (known.empty() || !tinygltf::DecodeDataURI(&bytes, type, known, 0, false))
    throw ImportError(place, "its data URI is not base64");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

void GltfLuminaires::add(const tinygltf::Node& node, std::size_t index, const Placement& placement, Scene& scene) {
  const auto extension = node.extensions.find(extension_name);
  if (extension == node.extensions.end()) return;
  const std::string place = "node " + std::to_string(index);
  const int which = index_in(extension->second, "light");
  const LuminaireFile& file = profile(which, place);
  Light light;
  light.kind = LightKind::luminaire;
  light.name = node.name.empty() ? "luminaire " + std::to_string(which) : node.name;
  light.intensity = number_in(extension->second, "multiplier", 1) * colour_in(extension->second);
  light.position = placement.origin;
  const Vec3 aim = placement.direction({0, 0, -1}), across = placement.direction({1, 0, 0});
  if (!(length(cross(aim, across)) > 0)) throw ImportError(place, "its luminaire points nowhere: the node is scaled to nothing");
  light.direction = normalized(aim);
  light.across = normalized(across - dot(across, light.direction) * light.direction);
  light.web = file.web;
  light.opening = file.opening;
  light.electrical_watts = file.watts;
  scene.lights.push_back(std::move(light));
}

const LuminaireFile& GltfLuminaires::profile(int which, const std::string& place) {
  if (const auto known = known_.find(which); known != known_.end()) return known->second;
  const auto extension = model_.extensions.find(extension_name);
  const bool is_there = extension != model_.extensions.end() && extension->second.IsObject() && extension->second.Has("lights") &&
                        extension->second.Get("lights").IsArray() && which >= 0 &&
                        static_cast<std::size_t>(which) < extension->second.Get("lights").ArrayLen();
  if (!is_there) throw ImportError(place, "light profile " + std::to_string(which) + " is not in the file");
  const std::string profile_place = "light profile " + std::to_string(which);
  const std::string bytes = bytes_of(extension->second.Get("lights").Get(which), profile_place);
  try {
    LuminaireFile file = read_luminaire(bytes, ".ies");
    for (const std::string& warning : file.warnings) warnings_.push_back(profile_place + ": " + warning);
    return known_.emplace(which, std::move(file)).first->second;
  } catch (const ImportError& error) {
    throw ImportError(profile_place, error.what());
  }
}

std::string GltfLuminaires::bytes_of(const tinygltf::Value& profile, const std::string& place) {
  if (!profile.IsObject()) throw ImportError(place, "is no object");
  if (profile.Has("uri") && profile.Get("uri").IsString()) {
    const auto& uri = profile.Get("uri").Get<std::string>();
    return uri.starts_with("data:") ? decoded_data(uri, place) : file_of_uri(files_, uri, place);
  }
  const auto bytes = bytes_of_view(model_, index_in(profile, "bufferView"));
  return {bytes.begin(), bytes.end()};
}

}  // namespace alvor
