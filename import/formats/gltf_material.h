#pragma once

#include "meshing/scene.h"

#include <string>
#include <vector>

namespace alvor_tinygltf {
class Model;
}
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// Returns the model's materials in order. baseColorFactor becomes reflectance; emissiveFactor x KHR_materials_emissive_strength,
/// a radiance, becomes emission. Textures count by their mean colour. Metals are treated as diffuse. Requires: `model.images`
/// hold encoded bytes.
std::vector<Material> read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings);

}  // namespace alvor
