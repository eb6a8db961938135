#include "import/formats/gltf_lights.h"

#include "import/base/import_error.h"
#include "import/formats/gltf_accessor.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

LightKind kind_of(const std::string& type, const std::string& place) {
  if (type == "point") return LightKind::point;
  if (type == "spot") return LightKind::spot;
  if (type == "directional") return LightKind::directional;
  throw ImportError(place, "its light is of the unknown type '" + type + "'");
}

Vec3 forward(const Placement& placement, const std::string& place) {
  const Vec3 direction = placement.direction({0, 0, -1});
  if (!(dot(direction, direction) > 0)) throw ImportError(place, "its light points nowhere: the node is scaled to nothing");
  return normalized(direction);
}

}  // namespace

void GltfLights::add(const tinygltf::Node& node, std::size_t index, const Placement& placement, Scene& scene) {
  const auto extension = node.extensions.find("KHR_lights_punctual");
  if (extension == node.extensions.end()) return;
  const std::string place = "node " + std::to_string(index);
  const tinygltf::Value& number = extension->second.Get("light");
  const int which = number.IsInt() ? number.GetNumberAsInt() : -1;
  if (which < 0 || static_cast<std::size_t>(which) >= model_.lights.size())
    throw ImportError(place, "light " + std::to_string(which) + " is not in the file");
  const tinygltf::Light& source = model_.lights[static_cast<std::size_t>(which)];
  Light light;
  light.name = !node.name.empty() ? node.name : !source.name.empty() ? source.name : "light " + std::to_string(which);
  light.kind = kind_of(source.type, place);
  const std::vector<double> colour = source.color.size() == 3 ? source.color : std::vector<double>{1, 1, 1};
  light.intensity = source.intensity * Rgb{colour[0], colour[1], colour[2]};
  if (light.intensity.min() < 0) return void(++negative_);
  light.position = placement.origin;
  if (light.kind != LightKind::point) light.direction = forward(placement, place);
  if (light.kind == LightKind::spot) {
    light.outer_cone = source.spot.outerConeAngle;
    light.inner_cone = std::min(source.spot.innerConeAngle, light.outer_cone);
  }
  if (!light.is_distant()) light.radius = std::max(number_in(source.extras, "radius", 0), number_in(node.extras, "radius", 0));
  ranges_ += source.range > 0;
  ++lights_;
  scene.lights.push_back(std::move(light));
}

void GltfLights::append_warnings(std::vector<std::string>& warnings) const {
  const auto counted = [](std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
  };
  if (ranges_ > 0)
    warnings.push_back(counted(ranges_, "light has a range, which is", "lights have a range, which is") +
                       " ignored: light fades with the square of the distance only");
  if (negative_ > 0)
    warnings.push_back(
        counted(negative_, "light of negative intensity is left out", "lights of negative intensity are left out"));
  if (lights_ > 0 && model_.asset.generator.find("Blender") != std::string::npos)
    warnings.push_back(
        "Blender wrote this file: unless its exporter was told otherwise (lighting mode), lamps are 683 times as bright "
        "beside emissive surfaces as in Blender, which --light-scale 0.001464 corrects; area lamps are not in the file");
}

}  // namespace alvor
