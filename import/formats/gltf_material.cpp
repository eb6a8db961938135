#include "import/formats/gltf_material.h"

#include "import/formats/gltf_accessor.h"
#include "import/formats/texture_colour.h"
#include "import/formats/tiny_gltf.h"

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

std::optional<Rgb> mean_of(const tinygltf::Model& model, const tinygltf::Image* image) {
  if (!image) return std::nullopt;
  return mean_colour(image->bufferView >= 0 ? bytes_of_view(model, image->bufferView) : std::span(image->image));
}

std::string name_of(const tinygltf::Image* image, int texture) {
  if (image && !image->name.empty()) return image->name;
  if (image && !image->uri.empty()) return image->uri;
  return std::to_string(texture);
}

Rgb under_texture(const tinygltf::Model& model, const Rgb& factor, const tinygltf::TextureInfo& texture,
                  const std::string& material, std::vector<std::string>& warnings) {
  if (texture.index < 0 || factor.is_zero()) return factor;
  const tinygltf::Image* image = image_of(model, texture.index);
  const std::string name = "material '" + material + "': texture '" + name_of(image, texture.index) + "'";
  return textured(factor, mean_of(model, image), name, warnings);
}

Rgb rgb_of(const std::vector<double>& factor) { return factor.size() < 3 ? Rgb{} : Rgb{factor[0], factor[1], factor[2]}; }

double emissive_strength(const tinygltf::Material& material) {
  const auto extension = material.extensions.find("KHR_materials_emissive_strength");
  if (extension == material.extensions.end() || !extension->second.Has("emissiveStrength")) return 1;
  return extension->second.Get("emissiveStrength").GetNumberAsDouble();
}

}  // namespace

std::vector<Material> read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings) {
  std::vector<Material> materials;
  for (const tinygltf::Material& source : model.materials) {
    const std::string name = source.name.empty() ? std::to_string(materials.size()) : source.name;
    const tinygltf::PbrMetallicRoughness& surface = source.pbrMetallicRoughness;
    const Rgb reflectance = under_texture(model, rgb_of(surface.baseColorFactor), surface.baseColorTexture, name, warnings);
    const Rgb light = emissive_strength(source) * rgb_of(source.emissiveFactor);
    const Rgb radiance = under_texture(model, light, source.emissiveTexture, name, warnings);
    materials.push_back({name, emission_of_radiance(radiance), reflectance, source.doubleSided});
  }
  return materials;
}

}  // namespace alvor
