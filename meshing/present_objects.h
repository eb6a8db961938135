#pragma once
// The objects and faces of an edited scene that are there: those that no edit has taken away.

#include "meshing/scene.h"
#include "meshing/scene_object.h"
#include "meshing/welded_faces.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Numbers the objects that are not hidden, and the faces that are not theirs, anew, in their order.
class PresentObjects {
 public:
  /// Requires: no object has a fault (fault_in()).
  explicit PresentObjects(std::span<const SceneObject> objects);

  /// Returns the objects that are there as if the scene had been submitted with them: none is moved or added.
  const std::vector<SceneObject>& objects() const { return objects_; }
  /// Returns whether a face is there.
  bool has(std::uint32_t face) const;
  /// Returns the new number of a face. Requires: has(face).
  std::uint32_t number_of(std::uint32_t face) const;
  /// Returns the new numbers of faces, of which the first is there.
  InputFaces numbers_of(InputFaces faces) const;

 private:
  struct Gap {
    std::uint32_t first, last;  ///< the faces [first, last) are not there
    std::uint32_t so_far;       ///< faces of this gap and of those before it
  };
  const Gap* gap_up_to(std::uint32_t face) const;

  std::vector<SceneObject> objects_;
  std::vector<Gap> gaps_;  // ascending
};

/// Returns what is there of an edited scene, as a scene of its own: without hidden objects, their faces and their lamps, and with
/// the vertices of the faces that remain. Materials keep their numbers. Requires: !find_fault(edited).
Scene present_scene(const Scene& edited);

}  // namespace alvor
