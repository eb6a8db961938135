#pragma once
// How solution files hold the materials and objects of their scene.

#include "meshing/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace alvor {

/// Returns {"name", "emission", "reflectance", "two_sided"}, with "regular_transmittance" and
/// "diffuse_transmittance" where they are not zero; emission in W/m2 or lm/m2, the shares of light without a unit, per band.
nlohmann::json json_of(const Material& material);
/// Reads what json_of() wrote. Throws SolutionFileError that names the material by `number`.
Material material_of(const nlohmann::json& json, std::size_t number);

/// Returns the JSON of all items; none if together they are longer than `most_bytes` as text. For materials and objects: a scene
/// may have a million, and what is written must be readable.
template <class Item>
std::vector<nlohmann::json> json_of_all(std::span<const Item> items, std::size_t most_bytes);

/// Returns {"name", "first_face", "face_count"}, with "parent" if it has one, and "transform" (12 numbers, see
/// alvor.v1.SceneObject) if that is not the identity.
nlohmann::json json_of(const SceneObject& object);
/// Reads what json_of() wrote; see fault_in() for whether it fits the other objects. Throws SolutionFileError that names the
/// object by `number`.
SceneObject object_of(const nlohmann::json& json, std::size_t number);

}  // namespace alvor
