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

namespace alvor {

/// Appends a copy of an object and of those that hang from it, as one object. Its faces, vertices and corners come after all
/// others. Requires: `of` is the number of an object.
void append_copy(Scene& scene, std::string name, std::uint32_t of);

/// Appends the copies among `edits`, in their order. Those that were taken back are hidden, and have other names: "NAME (taken
/// back 7)". Requires: !fault_in(edits, scene).
void append_copies(Scene& scene, std::span<const SceneEdit> edits);

/// Returns whether any edit adds a copy.
bool has_copies(std::span<const SceneEdit> edits);

/// Returns whether an object is a copy that an undo took back. Requires: its scene has copies of objects, but no other edits.
inline bool is_taken_back(const SceneObject& object) { return object.copy_of && object.is_hidden; }

/// Makes copies of objects in a scene, one after the other, after it has looked for their faults.
class CheckedCopies {
 public:
  /// The scene must outlive it.
  explicit CheckedCopies(Scene& scene);
  /// Appends a copy; or returns its fault, of edit 0, and changes nothing.
  std::optional<EditFault> make(const ObjectCopy& copy);

 private:
  Scene& scene_;
  std::unordered_map<std::string, std::uint32_t> names_;  // of objects that were not taken back
  std::size_t room_ = 0;                                  // faces that copies may have
  std::size_t copied_faces_ = 0, copies_ = 0;
};

}  // namespace alvor
