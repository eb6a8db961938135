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
/// first face that they meet. What lies neither in such a cell nor beside one sees the boxes at most through a gap, or is left
/// out by chance: at the distance of the whole scene one of 300 places that see one of few boxes, and one of ten that see a
/// single one of twenty; at half of that distance hardly any. Immutable.
class SeenSpace {
 public:
  /// Returns the number of rays that are sent from some boxes, and added to the budget, whatever that allows.
  static std::size_t rays_from(std::size_t boxes);

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
