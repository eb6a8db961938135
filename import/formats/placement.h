#pragma once
// Adds meshes and objects to a scene, placed by node transforms.

#include "meshing/placement.h"
#include "meshing/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace alvor {

/// Appends the placed vertices and returns the index of the first. Throws ImportError when instances of meshes add up to too many
/// vertices: a file of a few kilobytes can ask for any number.
std::uint32_t add_placed_vertices(Scene& scene, std::span<const Vec3> vertices, const Placement& placement);

/// Appends a face; `points` and `colours` as in Scene::add_face. Reverses its corners if the placement mirrors, so that its front
/// stays its front. Throws ImportError when there are too many.
void add_placed_face(Scene& scene, std::span<const std::uint32_t> polygon, std::uint32_t material, const Placement& placement,
                     std::span<const TexturePoint> points = {}, std::span<const RgbF> colours = {});

/// Appends an object that has no faces yet, and returns its number.
std::uint32_t add_object(Scene& scene, std::string name, std::optional<std::uint32_t> parent, const Placement& placement);
/// Gives object `which` the faces that were added since it was. Requires: none of them belongs to an object.
void take_new_faces(Scene& scene, std::uint32_t which);

/// Adds the grey material for faces that name none, and returns its index.
std::uint32_t add_default_material(Scene& scene);

/// Reflectance of a material that gives none.
inline constexpr Rgb default_reflectance{0.5, 0.5, 0.5};

}  // namespace alvor
