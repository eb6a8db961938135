#include "radiosity/solve/hit_boxes.h"

namespace alvor {

void HitBoxes::heed(const BaseMesh& mesh) {
  box_of_face_.clear();
  for (const RootPatch& root : mesh.roots()) {
    BoundingBox& box = box_of_face_.emplace_back();
    for (int c = 0; c < root.corner_count; ++c) box.add(root.corners[static_cast<std::size_t>(c)]);
  }
}

void HitBoxes::note(NodeIndex row, const BoundingBox& patch, std::span<const PatchId> hits) {
  BoundingBox box = patch;
  for (const PatchId hit : hits) box.add(box_of_face_[hit.root_face()]);
  boxes_[row] = box;
}

}  // namespace alvor
