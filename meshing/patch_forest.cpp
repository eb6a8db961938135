#include "meshing/patch_forest.h"

#include <algorithm>
#include <cassert>
#include <cstdlib>

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

/// Walks down by the digits of a place that has slabs itself, and by the coordinates of one that has none.
NodeIndex PatchForest::leaf_in_slabs(PatchId place, NodeIndex from) const {
  if (place.has_slabs()) {
    for (int level = id(from).level() + 1; first_child_[from] != 0; ++level) from = child(from, place.child_index(level));
    return from;
  }
  // Bits of u and v that are not used yet, the next one at bit max_level - 1.
  const auto path = static_cast<std::uint32_t>(place.bits()) >> 1;
  std::uint32_t u = gathered_bits(path) << id(from).halvings_of_u(), v = gathered_bits(path >> 1) << id(from).halvings_of_v();
  const auto next = [](std::uint32_t& coordinate, int bits) {
    const std::uint32_t taken = coordinate >> (PatchId::max_level - bits) & ((1u << bits) - 1);
    coordinate <<= bits;
    return static_cast<int>(taken);
  };
  while (first_child_[from] != 0) {
    switch (split_of(from)) {
      case Split::slabs_along_u: from = child(from, next(u, 2)); break;
      case Split::slabs_along_v: from = child(from, next(v, 2)); break;
      default: {
        const int half_u = next(u, 1), half_v = next(v, 1);
        from = child(from, half_u | half_v << 1);
      }
    }
  }
  return from;
}

NodeIndex PatchForest::node_in_place_of(PatchId patch) const {
  NodeIndex node = patch.root_face();
  for (int level = 1; level <= patch.level() && !is_leaf(node); ++level) node = child(node, patch.child_index(level));
  return node;
}

std::optional<Split> PatchForest::split_in_place_of(PatchId patch) const {
  const NodeIndex node = node_in_place_of(patch);
  return is_leaf(node) ? std::nullopt : std::optional(split_of(node));
}

bool PatchForest::may_split(NodeIndex leaf, const RefinementLimits& limits, Split how) const {
  const std::uint64_t more = mesh_->is_translucent(id(leaf).root_face()) ? 6 : 3;
  return leaf_count_ + more <= limits.max_leaves && is_large_enough(leaf, limits, how);
}

/// Returns whether all limits but that of the number of leaves allow a split.
bool PatchForest::is_large_enough(NodeIndex leaf, const RefinementLimits& limits, Split how) const {
  if (id(leaf).level() >= limits.max_level || !id(leaf).may_split(how)) return false;
  const bool is_slab = how != Split::quarters;
  if (is_slab && mesh_->roots()[id(leaf).root_face()].corner_count != 4) return false;
  if (limits.min_edge <= 0) return true;
  const PatchShape patch = shape(leaf);
  const auto corners = corners_of(*mesh_, patch);
  for (int e = 0; e < patch.corner_count; ++e) {
    const int parts = !is_slab ? 2 : (e % 2 == 0) == (how == Split::slabs_along_u) ? 4 : 1;
    if (length(corners[(e + 1) % patch.corner_count] - corners[e]) < parts * limits.min_edge) return false;
  }
  return true;
}

// Terminates: a leaf that must be split first has a longer longest edge than the leaf for which it is split.
bool PatchForest::split_coarser_neighbours(NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split_patches,
                                           const PatchForest* finer) {
  const PatchShape patch = shape(leaf);
  const std::int32_t longest = std::max(std::abs(patch.size_u), std::abs(patch.size_v));
  for (int e = 0; e < patch.corner_count; ++e) {
    const auto root_edge = root_edge_of(patch, e);
    const auto across = root_edge ? mesh_->across(patch.root, *root_edge) : std::nullopt;
    const int edge_there = across ? across->edge : e;  // within a root the edges of quads are parallel
    for (;;) {
      const NodeIndex other = leaf_across(patch, e, 0.5);
      if (other == no_node || shape(other).size_along(edge_there) <= longest) break;
      const auto how = finer ? finer->split_in_place_of(id(other)) : Split::quarters;
      if (!how || !is_large_enough(other, limits, *how)) break;
      if (!split(other, limits, split_patches, *how, finer)) return false;
    }
  }
  return true;
}

bool PatchForest::split(NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split_patches, Split how) {
  return split(leaf, limits, split_patches, how, nullptr);
}

bool PatchForest::split_as(const PatchForest& finer, NodeIndex leaf, const RefinementLimits& limits,
                           std::vector<NodeIndex>& split_patches) {
  const auto how = finer.split_in_place_of(id(leaf));
  return how && split(leaf, limits, split_patches, *how, &finer);
}

bool PatchForest::split(NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split_patches, Split how,
                        const PatchForest* finer) {
  assert(is_leaf(leaf));
  if (!may_split(leaf, limits, how)) return false;
  const NodeIndex behind = leaf_behind(leaf);
  if (!split_coarser_neighbours(leaf, limits, split_patches, finer)) return false;
  if (behind != no_node && !split_coarser_neighbours(behind, limits, split_patches, finer)) return false;
  if (!may_split(leaf, limits, how)) return false;
  for (const NodeIndex side : {leaf, behind}) {
    if (side == no_node) continue;
    split_one(side, side == leaf ? how : mirrored(how));
    split_patches.push_back(side);
  }
  return true;
}

void PatchForest::split_down_to(std::span<const LeafValue> patches) {
  for (const LeafValue& value : patches) {
    assert(value.patch.is_valid() && value.patch.root_face() < mesh_->roots().size());
    NodeIndex node = value.patch.root_face();
    for (int level = 1; level <= value.patch.level(); ++level) {
      if (is_leaf(node)) split_one(node, value.patch.split_above(level));
      node = child(node, value.patch.child_index(level));
    }
  }
}

void PatchForest::append(const AppendedRoots& roots) {
  for (NodeIndex& child : first_child_)
    if (child != 0) child = roots.moved(child & ~split_mask) | (child & split_mask);
  roots.make_room(first_child_);
  roots.make_room(ids_);
  for (NodeIndex root = roots.first; root < roots.first + roots.count; ++root) ids_[root] = PatchId::root(root);
  leaf_count_ += roots.count;
}

void PatchForest::split_one(NodeIndex leaf, Split how) {
  assert(is_leaf(leaf) && ids_.size() < (1u << split_shift));
  const auto first = static_cast<NodeIndex>(ids_.size());
  const PatchId parent = ids_[leaf];
  for (int k = 0; k < 4; ++k) ids_.push_back(parent.child(k, how));
  first_child_.resize(ids_.size());
  first_child_[leaf] = first | static_cast<std::uint32_t>(how) << split_shift;
  leaf_count_ += 3;
}

}  // namespace alvor
