#include "meshing/patch_forest.h"

#include <algorithm>
#include <cassert>

namespace alvor {

PatchForest::PatchForest(const BaseMesh& mesh) : mesh_(&mesh), leaf_count_(mesh.roots().size()) {
  ids_.reserve(mesh.roots().size());
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) ids_.push_back(PatchId::root(root));
  first_child_.resize(ids_.size());
}

std::vector<NodeIndex> PatchForest::leaves() const {
  std::vector<NodeIndex> all;
  all.reserve(leaf_count_);
  for (NodeIndex root = 0; root < mesh_->roots().size(); ++root) append_leaves_of(root, all);
  return all;
}

void PatchForest::append_leaves_of(NodeIndex node, std::vector<NodeIndex>& leaves) const {
  if (is_leaf(node)) return leaves.push_back(node);
  for (int k = 0; k < 4; ++k) append_leaves_of(child(node, k), leaves);
}

NodeIndex PatchForest::leaf_across(const PatchShape& shape, int edge, double fraction) const {
  const auto place = place_across(*mesh_, shape, edge, fraction);
  return place ? leaf_at(*place) : no_node;
}

bool PatchForest::may_split(NodeIndex leaf, const RefinementLimits& limits) const {
  const std::uint64_t more = mesh_->is_translucent(id(leaf).root_face()) ? 6 : 3;
  if (id(leaf).level() >= limits.max_level || leaf_count_ + more > limits.max_leaves) return false;
  if (limits.min_edge <= 0) return true;
  const PatchShape patch = shape(leaf);
  const auto corners = corners_of(*mesh_, patch);
  for (int e = 0; e < patch.corner_count; ++e)
    if (length(corners[(e + 1) % patch.corner_count] - corners[e]) < 2 * limits.min_edge) return false;
  return true;
}

bool PatchForest::split_coarser_neighbours(NodeIndex leaf, const RefinementLimits& limits,
                                           std::vector<NodeIndex>& split_patches) {
  const PatchShape patch = shape(leaf);
  for (int e = 0; e < patch.corner_count; ++e) {
    const NodeIndex other = leaf_across(patch, e, 0.5);
    if (other == no_node || id(other).level() >= id(leaf).level()) continue;
    if (!split(other, limits, split_patches)) return false;
  }
  return true;
}

bool PatchForest::split(NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split_patches) {
  assert(is_leaf(leaf));
  if (!may_split(leaf, limits)) return false;
  const NodeIndex behind = leaf_behind(leaf);
  if (!split_coarser_neighbours(leaf, limits, split_patches)) return false;
  if (behind != no_node && !split_coarser_neighbours(behind, limits, split_patches)) return false;
  if (!may_split(leaf, limits)) return false;
  for (const NodeIndex side : {leaf, behind}) {
    if (side == no_node) continue;
    split_one(side);
    split_patches.push_back(side);
  }
  return true;
}

void PatchForest::split_down_to(std::span<const LeafValue> patches) {
  for (const LeafValue& value : patches) {
    assert(value.patch.is_valid() && value.patch.root_face() < mesh_->roots().size());
    NodeIndex node = leaf_at(value.patch);
    while (id(node).level() < value.patch.level()) {
      split_one(node);
      node = child(node, value.patch.child_index(id(node).level() + 1));
    }
  }
}

void PatchForest::append(const AppendedRoots& roots) {
  for (NodeIndex& child : first_child_)
    if (child != 0) child = roots.moved(child);
  roots.make_room(first_child_);
  roots.make_room(ids_);
  for (NodeIndex root = roots.first; root < roots.first + roots.count; ++root) ids_[root] = PatchId::root(root);
  leaf_count_ += roots.count;
}

void PatchForest::split_one(NodeIndex leaf) {
  assert(is_leaf(leaf));
  const auto first = static_cast<NodeIndex>(ids_.size());
  const PatchId parent = ids_[leaf];
  for (int k = 0; k < 4; ++k) ids_.push_back(parent.child(k));
  first_child_.resize(ids_.size());
  first_child_[leaf] = first;
  leaf_count_ += 3;
}

}  // namespace alvor
