#pragma once
// The box around a scene, beyond which nothing blocks light.

#include "radiosity/rays/local_scene.h"

namespace alvor {

/// The bounding box of a scene, wider by 1e-5 on all sides so that rays that end on it meet what lies on the scene's own box.
/// Local units (see LocalFrame).
struct SceneBox {
  explicit SceneBox(const LocalScene& scene);
  /// Returns the distance from a point to where a ray in this direction (unit) leaves the box.
  double way_out(Vec3 from, Vec3 direction) const;

  Vec3 low, high;
};

}  // namespace alvor
