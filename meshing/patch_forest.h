#pragma once
// The forest of quadtrees: one quadtree per root patch.

#include "meshing/base_mesh.h"
#include "meshing/patch_place.h"
#include "solution/leaf_value.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// Index of a patch within its forest. Roots come first, in the order of the mesh; the four children of a patch are consecutive.
using NodeIndex = std::uint32_t;

/// Roots that a mesh got at its end. Their nodes come after those of the roots before; all further nodes move up.
struct AppendedRoots {
  NodeIndex first = 0;  ///< the first of them
  NodeIndex count = 0;

  NodeIndex moved(NodeIndex node) const { return node < first ? node : node + count; }
  /// Inserts values of the new roots into values by node, if there are any.
  template <class Values>
  void make_room(Values& by_node) const {
    if (!by_node.empty()) by_node.insert(by_node.begin() + first, count, typename Values::value_type{});
  }
};

struct RefinementLimits {
  int max_level = 10;
  std::uint64_t max_leaves = 200'000;
  double min_edge = 0;  ///< metres; no split makes an edge shorter than this
};

/// Keeps neighbouring leaves balanced, also across roots: before a leaf is split, neighbours are, until none that may be split
/// has an edge on it that is longer on the grid than its longest. So no edge is more than four times as long as the longest of
/// the leaf across; without slabs, levels of leaves that share an edge differ by one at most. The two sides of a translucent face
/// are split alike. Has fewer than 2^30 nodes. Borrows the mesh.
class PatchForest {
 public:
  explicit PatchForest(const BaseMesh& mesh);

  const BaseMesh& mesh() const { return *mesh_; }
  std::size_t node_count() const { return ids_.size(); }
  std::size_t leaf_count() const { return leaf_count_; }
  bool is_leaf(NodeIndex node) const { return first_child_[node] == 0; }
  PatchId id(NodeIndex node) const { return ids_[node]; }
  /// Requires: !is_leaf(node), 0 <= k < 4.
  NodeIndex child(NodeIndex node, int k) const { return (first_child_[node] & ~split_mask) + k; }
  /// Returns how a node is split. Requires: !is_leaf(node).
  Split split_of(NodeIndex node) const { return static_cast<Split>(first_child_[node] >> split_shift); }
  PatchShape shape(NodeIndex node) const { return shape_of(*mesh_, ids_[node]); }
  /// Loads a node's id, which will soon be asked for.
  void prefetch(NodeIndex node) const { __builtin_prefetch(&ids_[node]); }
  /// Returns all leaves in the order of their ids.
  std::vector<NodeIndex> leaves() const;
  /// Appends the leaves below `node` in the order of their ids, or `node` itself if it is a leaf.
  void append_leaves_of(NodeIndex node, std::vector<NodeIndex>& leaves) const;

  /// Returns the leaf that contains `place`: a patch that has slabs as the forest has, or a point (PatchId::finest). If `place`
  /// is split further, returns one of the leaves in it. O(levels).
  NodeIndex leaf_at(PatchId place) const { return leaf_at(place, place.root_face()); }
  /// Returns the leaf that contains `place`, starting at the node `from`. Requires: `from` contains `place`.
  NodeIndex leaf_at(PatchId place, NodeIndex from) const {
    if (first_child_[from] == 0) return from;
    if (place.has_slabs() || id(from).has_slabs()) return leaf_in_slabs(place, from);
    for (int level = id(from).level() + 1; first_child_[from] != 0; ++level) {
      if (first_child_[from] & split_mask) return leaf_in_slabs(place, from);
      from = first_child_[from] + place.child_index(level);
    }
    return from;
  }
  /// Returns the leaf across `edge` at `fraction` along it, or `no_node` where the surface ends.
  NodeIndex leaf_across(const PatchShape& shape, int edge, double fraction) const;
  static constexpr NodeIndex no_node = ~NodeIndex{0};
  /// Returns the leaf in the place of `leaf` on the other side of a translucent face; `no_node` for other faces.
  NodeIndex leaf_behind(NodeIndex leaf) const {
    return mesh_->is_translucent(id(leaf).root_face()) ? leaf_at(twin_of(*mesh_, id(leaf))) : no_node;
  }

  /// Returns the node with this id, or the leaf that contains it. Requires: `patch` has slabs as the forest has.
  NodeIndex node_in_place_of(PatchId patch) const;
  /// Returns how the node with this id is split; nothing if there is none, or it is a leaf.
  std::optional<Split> split_in_place_of(PatchId patch) const;

  bool may_split(NodeIndex leaf, const RefinementLimits& limits, Split how = Split::quarters) const;
  /// Splits `leaf` as told, and the leaf behind it alike, after splitting coarser neighbours into quarters as the balance
  /// demands. Appends every patch that was split to `split`. Returns false if a limit forbids the split, or too many leaves that
  /// of a neighbour; neighbours split before that stay split. Requires: is_leaf(leaf).
  bool split(NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split, Split how = Split::quarters);
  /// Splits `leaf`, and neighbours before it, as they are split in `finer`, a forest of the same mesh. Neighbours that are not
  /// split there stay. Returns false if `leaf` is not, or as split(). Requires: is_leaf(leaf).
  bool split_as(const PatchForest& finer, NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split);
  /// Splits until every patch of `patches` is a node, without balancing, each side by itself. Requires: valid ids of this mesh.
  void split_down_to(std::span<const LeafValue> patches);
  /// Takes roots that the mesh has got, as leaves. Requires: `first` is the number of roots before.
  void append(const AppendedRoots& roots);

 private:
  static constexpr int split_shift = 30;
  static constexpr std::uint32_t split_mask = 3u << split_shift;

  NodeIndex leaf_in_slabs(PatchId place, NodeIndex from) const;
  bool is_large_enough(NodeIndex leaf, const RefinementLimits& limits, Split how) const;
  bool split(NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split, Split how, const PatchForest* finer);
  bool split_coarser_neighbours(NodeIndex leaf, const RefinementLimits& limits, std::vector<NodeIndex>& split,
                                const PatchForest* finer);
  void split_one(NodeIndex leaf, Split how);

  const BaseMesh* mesh_;
  std::vector<PatchId> ids_;
  // 0: a leaf. The highest two bits tell the Split. Apart from the ids, so that walks down the tree touch little memory.
  std::vector<NodeIndex> first_child_;
  std::size_t leaf_count_ = 0;
};

}  // namespace alvor
