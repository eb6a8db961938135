#pragma once
// The space that is seen from some boxes, as cells of a grid.

#include "meshing/bounding_box.h"
#include "radiosity/rays/local_scene.h"
#include "radiosity/rays/ray_budget.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The cells of a grid over the scene that are crossed by rays sent outwards from boxes. The rays are random, and end at the
/// first face that they meet. What lies neither in such a cell nor beside one sees the boxes at most through a gap, or from so
/// far away that few of the rays get there. Immutable.
class SeenSpace {
 public:
  /// Rays that are sent from each box, and added to the budget, whatever that allows.
  static constexpr std::size_t rays_per_box = 8192;

  /// Boxes in metres; there is at least one.
  SeenSpace(const LocalScene& scene, std::span<const BoundingBox> boxes, std::uint64_t seed, RayBudget& budget);

  /// Returns whether part of a box, in metres, is in a cell that is seen or beside one.
  bool reaches(const BoundingBox& box) const;

 private:
  void mark(Vec3 from, Vec3 to);

  LocalFrame frame_;
  std::vector<std::uint8_t> is_seen_;  // by cell, x first
};

}  // namespace alvor
