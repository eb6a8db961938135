#pragma once
// The root patches that an edit of objects has moved, and the boxes in which they were and are.

#include "meshing/base_mesh.h"
#include "meshing/bounding_box.h"
#include "meshing/patch_place.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// The root patches that were moved, hidden or brought back between two meshes of the same roots, with a box for each object
/// before and after. A root that is hidden is in no box. Lengths in metres.
class MovedRoots {
 public:
  /// Requires: both meshes have the same roots, objects and frame (centre() and extent()).
  MovedRoots(const BaseMesh& before, const BaseMesh& after);

  bool is_empty() const { return old_boxes_.empty() && new_boxes_.empty(); }
  bool has(std::uint32_t root) const { return moved_[root] != 0; }
  bool has_any(std::span<const std::uint32_t> roots) const {
    return std::ranges::any_of(roots, [this](std::uint32_t root) { return has(root); });
  }
  const BoundingBox& all_new() const { return all_new_; }  ///< around all moved roots where they are now; empty if none is shown
  /// Returns whether a box touches one in which moved roots were or are.
  bool touch(const BoundingBox& box) const;
  /// Returns whether a ray that starts up to `radius` from `from` and ends at `to` may meet moved roots where they are now. May
  /// say so where it does not.
  bool may_meet_now(Vec3 from, Vec3 to, double radius) const;
  /// Returns whether a ray from within `from_radius` of `from` to within `to_radius` of `to` may meet moved roots where they were
  /// or are. May say so where it does not.
  bool may_meet(Vec3 from, double from_radius, Vec3 to, double to_radius) const;
  /// Returns whether part of a box in which moved roots are now, or were if `also_before`, lies in front of the plane through
  /// `point`.
  bool are_in_front(Vec3 point, Vec3 normal, bool also_before) const;
  /// Returns whether the places where moved roots were and are may together cover more than a share of the cosine-weighted
  /// directions of a point within `radius` of `from`. A sphere of radius R at the distance d covers at most (R / d)^2.
  bool may_cover(double share, Vec3 from, double radius) const;
  /// Returns the boxes in which moved roots were, and those in which they are, each a little larger than what is in it.
  std::vector<BoundingBox> boxes() const;
  /// Returns whether rays from outside may meet the back of a moved root that has no other side. They do not if moved roots
  /// enclose solids.
  bool show_backs() const { return show_backs_; }

 private:
  std::vector<std::uint8_t> moved_;  ///< by root
  bool show_backs_ = false;
  std::vector<BoundingBox> old_boxes_, new_boxes_;
  BoundingBox all_new_;  ///< around new_boxes_
};

BoundingBox box_of(const RootPatch& root);
/// Returns the box of a patch.
BoundingBox box_of(const BaseMesh& mesh, const PatchShape& shape);

/// Returns the share of the way between two points that lies before the box; 0 from inside it. Nothing if the way misses it.
std::optional<double> share_before(const BoundingBox& box, Vec3 from, Vec3 to);

}  // namespace alvor
