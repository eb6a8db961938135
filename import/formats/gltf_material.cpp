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

/// Returns the images that a texture may show, see images_of().
std::vector<const tinygltf::Image*> images_in(const tinygltf::Model& model, int texture) {
  std::vector<const tinygltf::Image*> images;
  if (const tinygltf::Texture* const found = element(model.textures, texture))
    for (const int number : images_of(*found))
      if (const tinygltf::Image* const image = element(model.images, number)) images.push_back(image);
  return images;
}

std::span<const unsigned char> encoded_bytes(const tinygltf::Model& model, const tinygltf::Image& image) {
  return image.bufferView >= 0 ? bytes_of_view(model, image.bufferView) : std::span(image.image);
}

/// Returns the name of the first image that a texture may show, or else the texture's number.
std::string name_of(const tinygltf::Model& model, int texture) {
  const auto images = images_in(model, texture);
  if (!images.empty() && !images.front()->name.empty()) return images.front()->name;
  if (!images.empty() && !images.front()->uri.empty()) return images.front()->uri;
  return std::to_string(texture);
}

/// Returns what no two images of a file have in common: the number, and for people a name.
std::string key_of(const tinygltf::Model& model, const tinygltf::Image& image) {
  const auto number = static_cast<std::size_t>(&image - model.images.data());
  return std::to_string(number) + (image.name.empty() ? "" : " " + image.name);
}

Wrap wrap_of(int mode) {
  if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::clamp;
  return mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror : Wrap::repeat;
}

/// Replaces `numbers` by those of the array `name`; an array of another length is ignored, and what is no number in it.
template <std::size_t count>
void read_numbers(const tinygltf::Value& object, const char* name, double (&numbers)[count]) {
  if (!object.IsObject() || !object.Has(name) || !object.Get(name).IsArray() || object.Get(name).ArrayLen() != count) return;
  for (std::size_t i = 0; i < count; ++i)
    if (const tinygltf::Value& number = object.Get(name).Get(i); number.IsNumber()) numbers[i] = number.GetNumberAsDouble();
}

/// Returns the number of an element that an object has as `name`; -1 if there is none.
int index_in(const tinygltf::Value& object, const char* name) {
  return static_cast<int>(std::clamp(number_in(object, name, -1), -1.0, 1e9));
}

/// Returns the number of the texture that an extension uses as `name`; -1 if there is none.
int texture_in(const tinygltf::Value& extension, const char* name) {
  return extension.IsObject() && extension.Has(name) ? index_in(extension.Get(name), "index") : -1;
}

GltfTextureMap map_of(const tinygltf::TextureInfo& texture) {
  GltfTextureMap map{.set = texture.texCoord};
  const auto extension = texture.extensions.find("KHR_texture_transform");
  if (extension == texture.extensions.end() || !extension->second.IsObject()) return map;
  const tinygltf::Value& transform = extension->second;
  read_numbers(transform, "offset", map.offset);
  read_numbers(transform, "scale", map.scale);
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

constexpr const char *diffuse_transmission = "KHR_materials_diffuse_transmission",
                     *transmission_texture = "diffuseTransmissionTexture",
                     *transmission_colour_texture = "diffuseTransmissionColorTexture";

/// Reads the materials of a model, each by itself, with the images that they share. Borrows both.
class MaterialReader {
 public:
  MaterialReader(const tinygltf::Model& model, std::vector<std::string>& warnings) : model_(model), warnings_(warnings) {}

  Material read(const tinygltf::Material& source, const std::string& name) {
    Material material{name, {}, {}, source.doubleSided, {}, {}};
    const double opacity = cover(source, material);
    emit(source, material);
    const double through = transmission_of(source);
    if (through > 0) let_through(material, through);
    scatter(source, 1 - through, material);
    if (opacity < 1) leave(material, opacity);
    return material;
  }

  /// Returns the image by which the emission of a material changes from place to place; null if there is none.
  std::shared_ptr<const ColourImage> emission_image(const tinygltf::Material& source, const Material& material) {
    if (material.emission.is_zero()) return nullptr;
    auto image = colours_of(source.emissiveTexture.index, {});
    return image && has_equal_texels(*image) ? nullptr : image;
  }
  Wrap wrap_s(int texture) const { return wrap_of(sampler_of(texture) ? sampler_of(texture)->wrapS : 0); }
  Wrap wrap_t(int texture) const { return wrap_of(sampler_of(texture) ? sampler_of(texture)->wrapT : 0); }

  void append_warnings() const { images_.append_warnings(warnings_); }

 private:
  const tinygltf::Sampler* sampler_of(int texture) const {
    const tinygltf::Texture* const found = element(model_.textures, texture);
    return found ? element(model_.samplers, found->sampler) : nullptr;
  }

  /// The colour and the opacity that a material has in the mean over a texture.
  struct Average {
    Rgb colour;
    double opacity = 1;
  };

  Average averaged(const Rgb& factor, int texture, const AlphaUse& alpha, const std::string& material) {
    if (texture < 0 || (factor.is_zero() && alpha.is_ignored())) return {factor, alpha.opacity(1)};
    const auto mean = mean_of(texture, alpha);
    return {textured(factor, mean, place_of(texture, material), warnings_), mean ? mean->opacity : alpha.opacity(1)};
  }

  std::optional<MeanTexel> mean_of(int texture, const AlphaUse& alpha) const {
    for (const tinygltf::Image* const image : images_in(model_, texture))
      if (auto mean = mean_texel(encoded_bytes(model_, *image), alpha)) return mean;
    return std::nullopt;
  }

  /// Returns the first image of a texture that can be decoded; null if there is none.
  std::shared_ptr<const ColourImage> colours_of(int texture, const AlphaUse& alpha) {
    for (const tinygltf::Image* const image : images_in(model_, texture))
      if (auto colours = images_.decoded(key_of(model_, *image), encoded_bytes(model_, *image), alpha)) return colours;
    return nullptr;
  }

  std::string place_of(int texture, const std::string& material) const {
    return "material '" + material + "': texture '" + name_of(model_, texture) + "'";
  }

  /// Sets the reflectance of a material and cuts out its holes, by place if it has a texture. Returns the share of the surface
  /// that is there if it is the same everywhere, else 1.
  double cover(const tinygltf::Material& source, Material& material) {
    const int texture = source.pbrMetallicRoughness.baseColorTexture.index;
    const Rgb factor = rgb_of(source.pbrMetallicRoughness.baseColorFactor);
    const AlphaUse alpha = alpha_use_of(source);
    const bool is_clear = transmission_of(source) > 0;  // has one tint; only its holes count by place
    const bool is_read = !alpha.is_ignored() || (!is_clear && !factor.is_zero());
    const auto colours = is_read ? colours_of(texture, alpha) : nullptr;
    if (!colours || (is_clear && !colours->has_opacity)) {
      const Average mean = averaged(factor, texture, alpha, material.name);
      material.reflectance = mean.colour;
      return mean.opacity;
    }
    return images_.cover(material, factor, colours, wrap_s(texture), wrap_t(texture));
  }

  /// Sets the emission of a material, in the mean over its texture.
  void emit(const tinygltf::Material& source, Material& material) {
    const Rgb light = emissive_strength(source) * rgb_of(source.emissiveFactor);
    const int texture = source.emissiveTexture.index;
    const auto mean = light.is_zero() || texture < 0 ? std::optional(MeanTexel{}) : mean_of(texture, {});
    if (!mean) warnings_.push_back(place_of(texture, material.name) + " cannot be read and is left out");
    material.emission = emission_of_radiance(mean ? light * mean->colour : light);
  }

  /// Makes a material translucent as KHR_materials_diffuse_transmission says. `rest` is the share of light that does not go
  /// straight through. Metal scatters none behind it.
  void scatter(const tinygltf::Material& source, double rest, Material& material) {
    const auto found = source.extensions.find(diffuse_transmission);
    if (found == source.extensions.end() || is_metal(source)) return;
    const tinygltf::Value& extension = found->second;
    const double given = number_in(extension, "diffuseTransmissionFactor", 0);
    double share = given >= 0 ? std::min(1.0, given) : 0, bands[3] = {1, 1, 1};
    if (share == 0) return;
    read_numbers(extension, "diffuseTransmissionColorFactor", bands);
    if (const int texture = texture_in(extension, transmission_texture); texture >= 0) {
      const auto mean = mean_of(texture, {AlphaUse::Kind::blended});
      if (mean) share *= mean->opacity;
      warnings_.push_back(place_of(texture, material.name) +
                          (mean ? " counts by the mean of its alpha" : " cannot be read and is left out"));
    }
    const int colour_texture = texture_in(extension, transmission_colour_texture);
    const Rgb colour = averaged({bands[0], bands[1], bands[2]}, colour_texture, {}, material.name).colour;
    scale_albedo(material, 1 - share);
    make_translucent(material, rest * share * colour);
  }

  const tinygltf::Model& model_;
  std::vector<std::string>& warnings_;
  ColourImages images_;
};

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

std::vector<int> textures_of(const tinygltf::Material& material) {
  std::vector<int> textures{material.pbrMetallicRoughness.baseColorTexture.index, material.emissiveTexture.index};
  if (const auto found = material.extensions.find(diffuse_transmission); found != material.extensions.end())
    for (const char* const name : {transmission_texture, transmission_colour_texture})
      textures.push_back(texture_in(found->second, name));
  return textures;
}

std::vector<int> images_of(const tinygltf::Texture& texture) {
  std::vector<int> images;
  if (const auto found = texture.extensions.find("EXT_texture_webp"); found != texture.extensions.end())
    images.push_back(index_in(found->second, "source"));
  images.push_back(texture.source);
  return images;
}

// Offset * rotation * scale. The rotation turns as in three.js and the Khronos sample viewer, by which the Khronos test model
// TextureTransformTest is right; the matrix printed in the specification turns the other way.
TexturePoint GltfTextureMap::of(TexturePoint given) const {
  const double s = scale[0] * double{given.s}, t = scale[1] * double{given.t};
  return texture_point(cosine * s + sine * t + offset[0], -sine * s + cosine * t + offset[1]);
}

GltfMaterials read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings) {
  GltfMaterials read;
  MaterialReader reader(model, warnings);
  for (const tinygltf::Material& source : model.materials) {
    const std::string name = source.name.empty() ? std::to_string(read.materials.size()) : source.name;
    read.texture_maps.push_back(map_of(source.pbrMetallicRoughness.baseColorTexture));
    read.emission_maps.push_back(map_of(source.emissiveTexture));
    read.materials.push_back(reader.read(source, name));
    const int texture = source.emissiveTexture.index;
    if (auto image = reader.emission_image(source, read.materials.back()))
      read.emission_textures.set(static_cast<std::uint32_t>(read.materials.size() - 1), std::move(image), reader.wrap_s(texture),
                                 reader.wrap_t(texture));
  }
  reader.append_warnings();
  return read;
}

}  // namespace alvor
