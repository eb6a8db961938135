#pragma once
// Finds the openings of rooms, such as windows and doors.

#include "radiosity/direct/flat_rectangle.h"
#include "radiosity/direct/scene_box.h"
#include "radiosity/rays/local_scene.h"

#include <vector>

namespace alvor {

/// A ray that was sent from a face. Local units; the direction is unit.
struct ProbeRay {
  Vec3 from, direction;
};
/// Rays that were sent to find openings.
struct ProbeRays {
  /// Number of rays that stayed for which one is kept, in proportion to those that left.
  static constexpr int each_stayed = 8;
  std::vector<ProbeRay> left, stayed;  ///< the scene, or in the scene
};

/// Returns rectangles of which each ray that left crosses one at least. They lie in the planes of walls and panes, where the rays
/// that left crossed in a narrow place, or else on the sides of the bounding box. Those come first through which most of all rays
/// leave that point at them.
std::vector<FlatRectangle> find_openings(const LocalScene& scene, const SceneBox& box, const ProbeRays& rays);

}  // namespace alvor
