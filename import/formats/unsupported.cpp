#include "import/formats/unsupported.h"

namespace alvor {

namespace {

struct Kind {
  const char* one;
  const char* many;
  const char* treatment;
};

void append(std::vector<std::string>& warnings, std::size_t count, const Kind& kind) {
  if (count == 0) return;
  warnings.push_back(std::to_string(count) + " " + (count == 1 ? kind.one : kind.many) + (count == 1 ? " is " : " are ") +
                     kind.treatment);
}

}  // namespace

void Unsupported::append_warnings(std::vector<std::string>& warnings) const {
  append(warnings, point_lights, {"point light", "point lights", "ignored"});
  append(warnings, spot_lights, {"spot light", "spot lights", "ignored"});
  append(warnings, directional_lights, {"directional light", "directional lights", "ignored"});
  append(warnings, area_lights, {"area light", "area lights", "ignored"});
  append(warnings, other_lights, {"light of another kind", "lights of other kinds", "ignored"});
  append(warnings, metals, {"metallic material", "metallic materials", "taken for diffuse"});
  append(warnings, clear_materials, {"clear material", "clear materials", "taken for thin panes, without refraction"});
  append(warnings, transmission_textures, {"texture of transmission", "textures of transmission", "ignored"});
}

std::vector<bool> used_materials(const Scene& scene) {
  std::vector<bool> used(scene.materials.size());
  for (const Face& face : scene.faces)
    if (face.material < used.size()) used[face.material] = true;
  return used;
}

}  // namespace alvor
