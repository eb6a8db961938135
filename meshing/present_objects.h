#pragma once
// The objects, faces and lights of an edited scene that no edit has hidden.

#include "meshing/light.h"
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

/// Returns the lights that no edit has hidden.
std::vector<Light> present_lights(std::span<const Light> lights);

}  // namespace alvor
