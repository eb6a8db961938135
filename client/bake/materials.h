#pragma once
// Materials of glTF files with baked light.

#include "client/bake/gltf_document.h"

#include <cstddef>

namespace alvor {

/// Returns the material of a primitive; an empty object if it has none. Throws BakeError if it is not in the file.
nlohmann::json material_of(const nlohmann::json& primitive, const GltfDocument& document);
/// Returns whether both sides of a primitive are drawn.
bool is_two_sided(const nlohmann::json& primitive, const GltfDocument& document);
/// Returns whether a material emits light of its own.
bool emits_light(const nlohmann::json& material);
/// Returns whether a material's base colour has an image.
bool has_base_image(const nlohmann::json& material);
/// Returns whether a material has a texture, other than one of baked light, that lies by a set of texture coordinates.
bool uses_set(const nlohmann::json& material, std::size_t set);
/// Returns whether one sees through a material where its image or glass says so, which an image of colours cannot show.
bool shows_what_is_behind(const nlohmann::json& material);

/// Returns a material with the lightmap `texture` ({"index", "texCoord"}), in the extension MOZ_lightmap. `intensity`: the value
/// of a white texel.
nlohmann::json with_lightmap(nlohmann::json material, nlohmann::json texture, double intensity);
/// Returns a material that shows the base colour `base` ({"baseColorFactor", "baseColorTexture"}) as it is, with
/// KHR_materials_unlit. Name, extras, sides and constant opacity are those of `material`.
nlohmann::json unlit(const nlohmann::json& material, nlohmann::json base);

}  // namespace alvor
