#pragma once

#include "meshing/scene.h"

#include <string>
#include <vector>

namespace alvor_tinygltf {
class Model;
}
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// The model's materials, in its order: baseColorFactor becomes reflectance, emissiveFactor x KHR_materials_emissive_strength
/// becomes emission, textures count by their mean. What is metal is taken for diffuse.
/// Requires: `model.images` hold encoded bytes.
std::vector<Material> read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings);

}  // namespace alvor
