#include "client/bake/materials.h"

#include <algorithm>
#include <vector>

namespace alvor {

using nlohmann::json;

json material_of(const json& primitive, const GltfDocument& document) {
  if (!primitive.contains("material")) return json::object();
  return document.element("materials", index_in(primitive, "material", "primitive"));
}

bool is_two_sided(const json& primitive, const GltfDocument& document) {
  return material_of(primitive, document).value("doubleSided", false);
}

bool emits_light(const json& material) {
  const json factor = material.value("emissiveFactor", json::array());
  return std::ranges::any_of(factor, [](const json& band) { return band.is_number() && band.get<double>() > 0; });
}

bool uses_set(const json& material, std::size_t set) {
  std::vector<const json*> stack{&material};
  while (!stack.empty()) {
    const json& next = *stack.back();
    stack.pop_back();
    if (next.is_object() && next.contains("texCoord") && next["texCoord"] == set) return true;
    for (const auto& [key, member] : next.items())
      if (member.is_structured() && key != "MOZ_lightmap") stack.push_back(&member);
  }
  return false;
}

bool has_base_image(const json& material) {
  return material.contains("pbrMetallicRoughness") && material["pbrMetallicRoughness"].contains("baseColorTexture");
}

bool shows_what_is_behind(const json& material) {
  const bool has_alpha = material.value("alphaMode", "OPAQUE") != "OPAQUE";
  const bool is_glass = material.contains("extensions") && material["extensions"].contains("KHR_materials_transmission");
  return (has_alpha && has_base_image(material)) || is_glass;
}

json with_lightmap(json material, json texture, double intensity) {
  texture["intensity"] = intensity;
  material["extensions"]["MOZ_lightmap"] = std::move(texture);
  return material;
}

json unlit(const json& material, json base) {
  if (material.contains("alphaMode") && material.contains("pbrMetallicRoughness")) {
    const json factor = material["pbrMetallicRoughness"].value("baseColorFactor", json::array({1, 1, 1, 1}));
    json shown = base.value("baseColorFactor", json::array({1, 1, 1, 1}));
    shown.at(3) = factor.at(3);
    base["baseColorFactor"] = std::move(shown);
  }
  base["metallicFactor"] = 0, base["roughnessFactor"] = 1;
  json made{{"pbrMetallicRoughness", std::move(base)}, {"extensions", {{"KHR_materials_unlit", json::object()}}}};
  for (const char* kept : {"name", "extras", "doubleSided", "alphaMode", "alphaCutoff"})
    if (material.contains(kept)) made[kept] = material[kept];
  return made;
}

}  // namespace alvor
