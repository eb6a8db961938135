#pragma once
// From which patches moved objects are seen.

#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/ray_budget.h"
#include "radiosity/solve/moved_roots.h"

#include <span>

namespace alvor {

/// A patch and the seed of its random numbers.
struct Viewpoint {
  PatchShape shape;
  std::uint64_t seed = 0;
};

/// Returns for each patch whether a box in which moved roots were or are is seen from its front: whether one of sixteen rays,
/// from points all over the patch to points all over the boxes, gets to the box. A patch that sees a tenth of the boxes is passed
/// over in one of five cases. Of many patches only those are asked that lie in the space that is seen from the boxes (SeenSpace).
/// Adds its rays to the budget, whatever that allows.
std::vector<std::uint8_t> see_moved(const LocalScene& scene, const MovedRoots& moved, std::span<const Viewpoint> patches,
                                    RayBudget& budget);

}  // namespace alvor
