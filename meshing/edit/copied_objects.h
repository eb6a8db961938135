#pragma once
// Copies of objects in a scene.

#include "meshing/edit/edited_scene.h"
#include "meshing/edit/scene_edit.h"
#include "meshing/scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace alvor {

/// Appends a copy of an object and of those that hang from it, as one object. Its faces, vertices, corners and lights come after
/// all others; lights that came with it are named "LIGHT of NAME". Requires: `of` is the number of an object.
void append_copy(Scene& scene, std::string name, std::uint32_t of);

/// Appends all faces and lights of another scene as one object, turned where that has another up axis. They and its materials
/// come after all others; these, and the lights, are named "MATERIAL of NAME". Where one scene is radiometric and the other
/// photometric, what they emit is converted by usual_lumens_per_watt. Requires: no light is distant.
void append_scene(Scene& scene, std::string name, const std::string& resource_name, const Scene& added);

/// Appends the copies among `edits`, in their order. Those that were taken back are hidden, and have other names: "NAME (taken
/// back 7)". Requires: !fault_in(edits, scene, added).
void append_copies(Scene& scene, std::span<const SceneEdit> edits, const AddedScenes& added = {});

/// Returns whether any edit adds a copy.
bool has_copies(std::span<const SceneEdit> edits);

/// Returns whether an object is a copy that an undo took back. Requires: its scene has copies of objects, but no other edits.
inline bool is_taken_back(const SceneObject& object) { return object.is_added() && object.is_hidden; }

/// Makes copies of objects in a scene, one after the other, after it has looked for their faults.
class CheckedCopies {
 public:
  /// Both must outlive it.
  CheckedCopies(Scene& scene, const AddedScenes& added);
  /// Appends a copy; or returns its fault, of edit 0, and changes nothing.
  std::optional<EditFault> make(const ObjectCopy& copy);

 private:
  std::optional<EditFault> fault_in(const ObjectCopy& copy) const;
  std::optional<std::string> fault_in(const Scene& added, const std::string& object) const;
  std::optional<std::string> fault_in_lights(std::span<const Light> lights, const std::string& object) const;

  void count(const SceneObject& object);

  Scene& scene_;
  const AddedScenes& added_;
  std::unordered_map<std::string, std::uint32_t> names_;  // of objects that were not taken back
  std::size_t room_ = 0;                                  // faces that copies may have
  std::size_t copied_faces_ = 0, copied_corners_ = 0, copied_lights_ = 0, copies_ = 0;
  std::unordered_set<std::string> materials_, lights_;  // names
  std::size_t added_materials_ = 0;                     // of added scenes
};

}  // namespace alvor
