#include "import/formats/gltf_material.h"

#include "import/formats/gltf_accessor.h"
#include "import/formats/see_through.h"
#include "import/formats/texture_colour.h"
#include "import/formats/tiny_gltf.h"

#include <algorithm>
#include <optional>

namespace alvor {

namespace {

template <class T>
const T* element(const std::vector<T>& list, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < list.size() ? &list[static_cast<std::size_t>(index)] : nullptr;
}

const tinygltf::Image* image_of(const tinygltf::Model& model, int texture) {
  const tinygltf::Texture* found = element(model.textures, texture);
  return found ? element(model.images, found->source) : nullptr;
}

std::optional<MeanTexel> mean_of(const tinygltf::Model& model, const tinygltf::Image* image, const AlphaUse& alpha) {
  if (!image) return std::nullopt;
  return mean_texel(image->bufferView >= 0 ? bytes_of_view(model, image->bufferView) : std::span(image->image), alpha);
}

std::string name_of(const tinygltf::Image* image, int texture) {
  if (image && !image->name.empty()) return image->name;
  if (image && !image->uri.empty()) return image->uri;
  return std::to_string(texture);
}

/// Returns the colour `factor` under a texture. Multiplies `opacity` by the texture's.
Rgb under_texture(const tinygltf::Model& model, const Rgb& factor, const tinygltf::TextureInfo& texture, const AlphaUse& alpha,
                  const std::string& material, double& opacity, std::vector<std::string>& warnings) {
  if (texture.index < 0 || (factor.is_zero() && alpha.kind == AlphaUse::Kind::ignored)) {
    opacity = alpha.opacity(1);
    return factor;
  }
  const tinygltf::Image* image = image_of(model, texture.index);
  const std::string name = "material '" + material + "': texture '" + name_of(image, texture.index) + "'";
  const auto mean = mean_of(model, image, alpha);
  opacity = mean ? mean->opacity : alpha.opacity(1);
  return textured(factor, mean, name, warnings);
}

AlphaUse alpha_use_of(const tinygltf::Material& material) {
  const std::vector<double>& colour = material.pbrMetallicRoughness.baseColorFactor;
  const double factor = colour.size() > 3 ? colour[3] : 1;
  if (material.alphaMode == "MASK") return {AlphaUse::Kind::cut, factor, material.alphaCutoff};
  if (material.alphaMode == "BLEND") return {AlphaUse::Kind::blended, factor, 0};
  return {};
}

Rgb rgb_of(const std::vector<double>& factor) { return factor.size() < 3 ? Rgb{} : Rgb{factor[0], factor[1], factor[2]}; }

double emissive_strength(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_emissive_strength");
  if (extension == material.extensions.end() || !extension->second.Has("emissiveStrength")) return 1;
  return extension->second.Get("emissiveStrength").GetNumberAsDouble();
}

}  // namespace

// With a texture, metallicFactor is usually left at its default 1, also for materials that are no metals.
bool is_metal(const tinygltf::Material& material) {
  const tinygltf::PbrMetallicRoughness& surface = material.pbrMetallicRoughness;
  return surface.metallicFactor > 0.5 && surface.metallicRoughnessTexture.index < 0;
}

double transmission_of(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_transmission");
  if (is_metal(material) || extension == material.extensions.end() || !extension->second.Has("transmissionFactor")) return 0;
  const double share = extension->second.Get("transmissionFactor").GetNumberAsDouble();
  return share >= 0 ? std::min(1.0, share) : 0;
}

std::vector<Material> read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings) {
  std::vector<Material> materials;
  for (const tinygltf::Material& source : model.materials) {
    const std::string name = source.name.empty() ? std::to_string(materials.size()) : source.name;
    const tinygltf::PbrMetallicRoughness& surface = source.pbrMetallicRoughness;
    double opacity = 1, of_light = 1;
    const Rgb reflectance = under_texture(model, rgb_of(surface.baseColorFactor), surface.baseColorTexture, alpha_use_of(source),
                                          name, opacity, warnings);
    const Rgb light = emissive_strength(source) * rgb_of(source.emissiveFactor);
    const Rgb radiance = under_texture(model, light, source.emissiveTexture, {}, name, of_light, warnings);
    materials.push_back({name, emission_of_radiance(radiance), reflectance, source.doubleSided});
    if (const double share = transmission_of(source); share > 0) let_through(materials.back(), share);
    if (opacity < 1) leave(materials.back(), opacity);
  }
  return materials;
}

}  // namespace alvor
