#pragma once
// The named parts of a scene.

#include "meshing/placement.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// A named part of a scene, such as a node of a scene file: some of the scene's faces, or only a holder of other objects. Its
/// number in Scene::objects is its id; a scene that is stored never changes it.
struct SceneObject {
  std::string name;  ///< not empty, and no other object's
  /// The object that this one hangs from: one with a lower number.
  std::optional<std::uint32_t> parent;
  /// Maps the object's own coordinates to those of the scene. The scene's vertices are mapped already.
  Placement placement;
  /// The faces [first_face, first_face + face_count) of the scene. They come after the faces of all objects before it.
  std::uint32_t first_face = 0, face_count = 0;
  /// Maps the faces from where the scene was submitted with them to where edits have put them: a rotation and a shift.
  /// `placement` and the scene's vertices are mapped already.
  Placement motion;
  bool is_hidden = false;  ///< an edit took it away: its faces send no light, reflect none and are in no light's way
  /// The object, of a lower number, of which an edit made this one. Its faces are copies of faces_with_hanging() of that one, in
  /// their order.
  std::optional<std::uint32_t> copy_of;
  /// The resource name of the scene whose faces, all of them, in their order, an edit added as this object; else empty.
  std::string from_scene;
  /// The lights, no faces, that an edit added with the object: the numbers [first_added_light, first_added_light + added_lights)
  /// of all lights that edits have added with objects. They move with it, and are dimmed and hidden as its faces are.
  std::uint32_t first_added_light = 0, added_lights = 0;

  /// Returns whether an edit added the object.
  bool is_added() const { return copy_of || !from_scene.empty(); }
  friend bool operator==(const SceneObject&, const SceneObject&) = default;
};

/// Returns the numbers of an object and of those that hang from it, ascending. Requires: no fault_in(objects).
std::vector<std::uint32_t> objects_with_hanging(std::span<const SceneObject> objects, std::uint32_t which);
/// Returns their faces, in the order of the objects. Requires: no fault_in(objects).
std::vector<std::uint32_t> faces_with_hanging(std::span<const SceneObject> objects, std::uint32_t which);

/// Returns why object `which` cannot be part of a scene with so many faces; nothing if it can. Names are not compared.
std::optional<std::string> fault_in(std::span<const SceneObject> objects, std::size_t which, std::size_t scene_faces);

}  // namespace alvor
