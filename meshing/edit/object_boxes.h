#pragma once

#include "meshing/bounding_box.h"
#include "meshing/scene.h"

#include <vector>

namespace alvor {

/// Boxes of the faces of a scene and of its objects.
struct ObjectBoxes {
  explicit ObjectBoxes(const Scene& scene);
  std::vector<BoundingBox> of_object;  ///< with those that hang from it; empty if they have no faces
  BoundingBox of_scene;
};

}  // namespace alvor
