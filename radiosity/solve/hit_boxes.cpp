#include "radiosity/solve/hit_boxes.h"

#include "radiosity/solve/moved_roots.h"

namespace alvor {

void HitBoxes::heed(const BaseMesh& mesh) {
  box_of_face_.clear();
  for (const RootPatch& root : mesh.roots()) box_of_face_.push_back(box_of(root));
}

void HitBoxes::note(NodeIndex row, const BoundingBox& patch, std::span<const PatchId> hits) {
  BoundingBox box = patch;
  for (const PatchId hit : hits) box.add(box_of_face_[hit.root_face()]);
  boxes_[row] = box;
}

}  // namespace alvor
