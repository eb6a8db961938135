#pragma once
// Boxes around all that rows have hit, which tell soon that a moved object is not in the way of a row's rays.

#include "meshing/base_mesh.h"
#include "meshing/bounding_box.h"
#include "meshing/patch_forest.h"
#include "solution/patch_id.h"

#include <span>
#include <vector>

namespace alvor {

/// For each node of the row forest a box around its patch and the faces that its row's rays have hit, in metres. 48 bytes a node,
/// and as many a root. Faces that were moved later are in the box where they were.
class HitBoxes {
 public:
  explicit HitBoxes(const BaseMesh& mesh) { heed(mesh); }

  /// Takes the places of all faces for rows that are noted from now on.
  void heed(const BaseMesh& mesh);
  void fit_to_nodes(std::size_t nodes) { boxes_.resize(nodes); }
  void append(const AppendedRoots& roots) { roots.make_room(boxes_); }
  /// Sets the box of a row to one around `patch`, the box of the row's patch, and all faces in `hits`. Different threads may call
  /// it for different rows. Requires: a face is known by heed(), a row by fit_to_nodes().
  void note(NodeIndex row, const BoundingBox& patch, std::span<const PatchId> hits);
  /// Returns the box of a row as it was noted last, an empty one if it never was.
  const BoundingBox& of(NodeIndex row) const { return boxes_[row]; }
  /// Returns whether the box of a row has a point in common with `box`.
  bool touches(NodeIndex row, const BoundingBox& box) const {
    const Vec3 low = upper(of(row).low, box.low), high = lower(of(row).high, box.high);
    return low.x <= high.x && low.y <= high.y && low.z <= high.z;
  }

 private:
  std::vector<BoundingBox> boxes_, box_of_face_;
};

}  // namespace alvor
