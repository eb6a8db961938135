#pragma once
// The two quadtree forests of a solve, with their neighbours.

#include "meshing/leaf_gradient.h"
#include "meshing/patch_forest.h"
#include "meshing/patch_reflectance.h"
#include "radiosity/plan/plan.h"
#include "radiosity/solve/moved_roots.h"
#include "solution/plain_bytes.h"

#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// The row forest, whose leaves have transport rows, and the leaf forest, whose leaves have direct light. Direct light is sharp
/// and indirect light smooth, so the leaf forest is finer; every row's place is a node of it. A row node and a leaf node have one
/// place if their ids are equal. Used by one thread at a time.
class Forests {
 public:
  /// As after split_as_at_start().
  Forests(const BaseMesh& mesh, const Plan& plan, const RefinementLimits& limits, const MethodParts& parts = {});

  const BaseMesh& mesh() const { return mesh_; }
  const PatchForest& rows() const { return rows_; }
  const PatchForest& leaves() const { return leaves_; }
  /// Return the leaves of either forest, sorted by id. Cheap where nothing was split since the last call, for they are kept: to
  /// be called by one thread at a time.
  std::vector<NodeIndex> all_rows() const { return row_list_.of(rows_); }
  std::vector<NodeIndex> all_leaves() const { return leaf_list_.of(leaves_); }
  double area() const { return area_; }  ///< area of all roots, m2

  /// Returns the row whose place contains the leaf node's.
  NodeIndex row_of(NodeIndex leaf) const { return rows_.leaf_at(leaves_.id(leaf)); }
  /// Returns the leaf node with the row's place. If the leaf forest is coarser there, returns the leaf that contains it.
  NodeIndex leaf_node_of(NodeIndex row) const;
  /// Appends the leaves within the row's place.
  void append_leaves_of_row(NodeIndex row, std::vector<NodeIndex>& leaves) const;

  std::span<const Vec3> row_centres() const { return row_centre_; }    ///< by row node
  std::span<const Vec3> leaf_centres() const { return leaf_centre_; }  ///< by leaf node
  /// How many leaves ahead of the one at hand a loop over all leaves, in the order of their ids, loads what is known of a leaf:
  /// leaves that follow each other lie apart in memory. Measured: 4 to 16 are as good.
  static constexpr std::size_t leaves_ahead = 8;
  /// Loads the id and the area of a leaf that will soon be asked for.
  void prefetch(NodeIndex leaf) const {
    leaves_.prefetch(leaf);
    __builtin_prefetch(&leaf_area_[leaf]);
  }
  double leaf_area(NodeIndex leaf) const { return leaf_area_[leaf]; }  ///< m2
  /// Returns the mean reflectance of what is there of a leaf node.
  Rgb reflectance(NodeIndex leaf) const {
    return mesh_.has_varying_reflectance() ? leaf_surface_[leaf].reflectance : material_of(leaf).reflectance;
  }
  /// Returns the share of a leaf node's area that is there and no hole.
  double cover(NodeIndex leaf) const { return mesh_.has_textures() ? leaf_surface_[leaf].cover : 1; }
  const Material& material_of(NodeIndex leaf) const { return mesh_.material_of(leaves_.id(leaf).root_face()); }
  /// Returns the leaf behind a leaf of a translucent face, PatchForest::no_node for others.
  NodeIndex leaf_behind(NodeIndex leaf) const { return leaves_.leaf_behind(leaf); }

  /// Returns the smooth neighbours of each leaf of the row or the leaf forest. Requires: leaves of that forest, each once.
  std::vector<SmoothNeighbours> row_neighbours(std::span<const NodeIndex> rows) { return row_neighbours_.of(rows); }
  std::vector<SmoothNeighbours> leaf_neighbours(std::span<const NodeIndex> leaves) { return leaf_neighbours_.of(leaves); }

  /// Returns whether a leaf, or a row, may be split as `wanted`, or into quarters instead (split_leaf(), split_row()).
  bool may_split_leaf(NodeIndex leaf, Split wanted = Split::quarters) const;
  bool may_split_row(NodeIndex row, Split wanted = Split::quarters) const;
  /// Splits a leaf of the leaf forest as `wanted`, or into quarters if it is too large for slabs or they are not allowed, after
  /// the neighbours that must go first. Appends every node that was split to `split`. Returns false if the limits forbid it.
  bool split_leaf(NodeIndex leaf, std::vector<NodeIndex>& split, Split wanted = Split::quarters);
  /// Splits a leaf of the row forest as the leaf forest is split there. Returns false if that is not split there, or the limits
  /// forbid it.
  bool split_row(NodeIndex row, std::vector<NodeIndex>& split);

  /// Takes roots that the mesh has got. To be followed by note_relit().
  void append(const AppendedRoots& roots);
  /// Finds the middles of nodes of roots again that have moved as rigid bodies.
  void note_moved(const MovedRoots& moved);
  /// Finds the reflectances of nodes again, after the materials of the mesh have changed.
  void note_relit();

  /// Splits the roots that light may reach as far as a solve needs before its first pass, where they are not split yet.
  void split_as_at_start(const Plan& plan);

  void save(PlainWriter& out) const;
  /// Reads what save() wrote. Throws BadBytes if the leaves are not those of this scene. Requires: no split since construction.
  void load(PlainReader& in);

 private:
  /// The leaves of a forest, in which nodes are only split.
  class LeafList {
   public:
    const std::vector<NodeIndex>& of(const PatchForest& forest);

   private:
    std::vector<NodeIndex> leaves_;
    std::size_t nodes_ = 0;  // of the forest when they were listed
  };

  Split allowed(NodeIndex leaf, Split wanted) const;
  void split_to_start(const Plan& plan);
  void split_to_show_textures(const Plan& plan);
  void fit_to_nodes();
  void find_area();

  const BaseMesh& mesh_;
  const RefinementLimits limits_;
  const bool may_have_slabs_;
  double area_ = 0;
  PatchForest rows_, leaves_;
  mutable LeafList row_list_, leaf_list_;
  std::vector<std::uint8_t> is_at_start_;  // by root: split_to_start() has left no coarse patch of it
  NeighbourTable row_neighbours_{rows_}, leaf_neighbours_{leaves_};
  std::vector<Vec3> row_centre_, leaf_centre_;
  std::vector<double> leaf_area_;
  std::optional<PatchReflectance> reflectance_;  // never empty
  std::vector<MeanSurface> leaf_surface_;        // by leaf node; none if no reflectance varies
};

/// Finds the rows of leaves one after the other. A leaf mostly has the row of the one before, if they are sorted by id.
class RowFinder {
 public:
  /// Borrows the forests.
  explicit RowFinder(const Forests& forests) : forests_(forests) {}
  NodeIndex row_of(NodeIndex leaf) {
    const bool is_same = row_ != PatchForest::no_node && forests_.rows().id(row_).contains(forests_.leaves().id(leaf));
    if (!is_same) row_ = forests_.row_of(leaf);
    return row_;
  }

 private:
  const Forests& forests_;
  NodeIndex row_ = PatchForest::no_node;
};

/// Sorts patches so that any first part of them is spread over the scene and holds much of its area. One patch of each face comes
/// first; within that the order is random, large patches sooner (weighted sampling without replacement, Efraimidis and Spirakis
/// 2006). The order of faces in files, storey by storey and room by room, would leave most rooms dark at first.
void spread_out(const PatchForest& forest, std::vector<NodeIndex>& patches);

}  // namespace alvor
