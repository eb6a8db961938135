#pragma once

#include "meshing/scene.h"

#include <string>
#include <vector>

namespace alvor_tinygltf {
class Model;
struct Material;
}  // namespace alvor_tinygltf
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// Returns whether a material is a metal, which counts as diffuse here.
bool is_metal(const tinygltf::Material& material);

/// Returns the share of light that KHR_materials_transmission lets through, in [0, 1]. Metal lets none through.
double transmission_of(const tinygltf::Material& material);

/// Returns the model's materials in order. baseColorFactor becomes reflectance; emissiveFactor x KHR_materials_emissive_strength,
/// a radiance, becomes emission. Alpha (BLEND, MASK) and KHR_materials_transmission let light straight through. Textures count by
/// their mean colour and opacity. Requires: `model.images` hold encoded bytes.
std::vector<Material> read_gltf_materials(const tinygltf::Model& model, std::vector<std::string>& warnings);

}  // namespace alvor
