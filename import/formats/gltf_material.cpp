#include "import/formats/gltf_material.h"

#include "import/formats/colour_images.h"
#include "import/formats/gltf_accessor.h"
#include "import/formats/see_through.h"
#include "import/formats/texture_colour.h"
#include "import/formats/tiny_gltf.h"

#include <algorithm>
#include <cmath>
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

std::span<const unsigned char> encoded_bytes(const tinygltf::Model& model, const tinygltf::Image& image) {
  return image.bufferView >= 0 ? bytes_of_view(model, image.bufferView) : std::span(image.image);
}

std::string name_of(const tinygltf::Image* image, int texture) {
  if (image && !image->name.empty()) return image->name;
  if (image && !image->uri.empty()) return image->uri;
  return std::to_string(texture);
}

/// Returns what no two images of a file have in common: the number, and for people a name.
std::string key_of(const tinygltf::Model& model, const tinygltf::Image& image) {
  const auto number = static_cast<std::size_t>(&image - model.images.data());
  return std::to_string(number) + (image.name.empty() ? "" : " " + image.name);
}

/// The colour and the opacity that a material has in the mean over a texture.
struct MeanSurface {
  Rgb colour;
  double opacity = 1;
};

MeanSurface mean_surface(const tinygltf::Model& model, const Rgb& factor, const tinygltf::TextureInfo& texture,
                         const AlphaUse& alpha, const std::string& material, std::vector<std::string>& warnings) {
  if (texture.index < 0 || (factor.is_zero() && alpha.kind == AlphaUse::Kind::ignored)) return {factor, alpha.opacity(1)};
  const tinygltf::Image* image = image_of(model, texture.index);
  const std::string name = "material '" + material + "': texture '" + name_of(image, texture.index) + "'";
  const auto mean = image ? mean_texel(encoded_bytes(model, *image), alpha) : std::nullopt;
  return {textured(factor, mean, name, warnings), mean ? mean->opacity : alpha.opacity(1)};
}

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

/// Returns the two numbers of KHR_texture_transform's array `name`.
void read_pair(const tinygltf::Value& transform, const char* name, double (&pair)[2]) {
  if (!transform.Has(name) || !transform.Get(name).IsArray() || transform.Get(name).ArrayLen() != 2) return;
  for (std::size_t i = 0; i < 2; ++i)
    if (const tinygltf::Value& number = transform.Get(name).Get(i); number.IsNumber()) pair[i] = number.GetNumberAsDouble();
}

GltfTextureMap map_of(const tinygltf::TextureInfo& texture) {
  GltfTextureMap map{.set = texture.texCoord};
  const auto extension = texture.extensions.find("KHR_texture_transform");
  if (extension == texture.extensions.end() || !extension->second.IsObject()) return map;
  const tinygltf::Value& transform = extension->second;
  read_pair(transform, "offset", map.offset);
  read_pair(transform, "scale", map.scale);
  const double rotation = number_in(transform, "rotation", 0);
  map.cosine = std::cos(rotation), map.sine = std::sin(rotation);
  map.set = static_cast<int>(std::clamp(number_in(transform, "texCoord", map.set), 0.0, 1000.0));
  return map;
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

// Offset * rotation * scale. The rotation turns as in three.js and the Khronos sample viewer, by which the Khronos test model
// TextureTransformTest is right; the matrix printed in the specification turns the other way.
TexturePoint GltfTextureMap::of(TexturePoint given) const {
  const double s = scale[0] * double{given.s}, t = scale[1] * double{given.t};
  return texture_point(cosine * s + sine * t + offset[0], -sine * s + cosine * t + offset[1]);
}

GltfMaterials read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings) {
  GltfMaterials read;
  ColourImages images;
  for (const tinygltf::Material& source : model.materials) {
    const std::string name = source.name.empty() ? std::to_string(read.materials.size()) : source.name;
    const tinygltf::PbrMetallicRoughness& surface = source.pbrMetallicRoughness;
    const tinygltf::TextureInfo& texture = surface.baseColorTexture;
    const AlphaUse alpha = alpha_use_of(source);
    const Rgb factor = rgb_of(surface.baseColorFactor), light = emissive_strength(source) * rgb_of(source.emissiveFactor);
    const double through = transmission_of(source);
    const tinygltf::Image* const image = image_of(model, texture.index);
    const bool is_opaque = alpha.kind == AlphaUse::Kind::ignored && through == 0 && !factor.is_zero();
    const auto colours = image && is_opaque ? images.decoded(key_of(model, *image), encoded_bytes(model, *image)) : nullptr;
    read.texture_maps.push_back(map_of(texture));
    Material& material = read.materials.emplace_back(Material{name, {}, {}, source.doubleSided, {}, {}});
    if (colours) {
      const tinygltf::Sampler* const sampler =
          element(model.samplers, model.textures[static_cast<std::size_t>(texture.index)].sampler);
      images.cover(material, factor, colours, wrap_of(sampler ? sampler->wrapS : 0), wrap_of(sampler ? sampler->wrapT : 0));
    }
    const MeanSurface mean =
        colours ? MeanSurface{material.reflectance} : mean_surface(model, factor, texture, alpha, name, warnings);
    material.reflectance = mean.colour;
    material.emission = emission_of_radiance(mean_surface(model, light, source.emissiveTexture, {}, name, warnings).colour);
    if (through > 0) let_through(material, through);
    if (mean.opacity < 1) leave(material, mean.opacity);
  }
  images.append_warnings(warnings);
  return read;
}

}  // namespace alvor
