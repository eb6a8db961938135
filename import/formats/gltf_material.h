#pragma once

#include "import/formats/emission_textures.h"
#include "meshing/scene.h"

#include <string>
#include <vector>

namespace alvor_tinygltf {
class Model;
struct Material;
struct Texture;
}  // namespace alvor_tinygltf
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// Returns whether a material is a metal, which counts as diffuse here.
bool is_metal(const tinygltf::Material& material);

/// Returns the share of light that KHR_materials_transmission lets through, in [0, 1]. Metal lets none through.
double transmission_of(const tinygltf::Material& material);

/// Returns the numbers of the textures that read_gltf_materials() reads for a material. Some may not be in the file.
std::vector<int> textures_of(const tinygltf::Material& material);

/// Returns the numbers of the images that a texture may show, the preferred one first: that of EXT_texture_webp, then its own
/// source. read_gltf_materials() takes the first that can be decoded. Some may not be in the file.
std::vector<int> images_of(const tinygltf::Texture& texture);

/// Maps texture coordinates of a glTF file to points of a texture: chooses a set of coordinates and applies
/// KHR_texture_transform.
struct GltfTextureMap {
  int set = 0;                                                         ///< of TEXCOORD_n
  double offset[2] = {0, 0}, scale[2] = {1, 1}, cosine = 1, sine = 0;  ///< of the rotation

  TexturePoint of(TexturePoint given) const;
};

struct GltfMaterials {
  std::vector<Material> materials;            ///< in the order of the model
  std::vector<GltfTextureMap> texture_maps;   ///< of their textures, by material
  std::vector<GltfTextureMap> emission_maps;  ///< of their emissive textures, by material
  EmissionTextures emission_textures;         ///< those of more than one colour
};

/// Returns the model's materials. baseColorFactor and its texture become reflectance; emissiveFactor x
/// KHR_materials_emissive_strength, a radiance, becomes emission. Alpha (BLEND, MASK), by place if a texture has it, and
/// KHR_materials_transmission let light straight through; KHR_materials_diffuse_transmission scatters it behind the surface.
/// A material's emission is its mean over the emissive texture. Textures of diffuse transmission count by their mean, and so does
/// that of the base colour of clear glass without holes.
/// Requires: `model.images` hold encoded bytes.
GltfMaterials read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings);

}  // namespace alvor
