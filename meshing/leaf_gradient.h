#pragma once
// Slopes of what the leaves hold, from differences with their neighbours.

#include "meshing/patch_forest.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// Slope per band along the leaf's plane, per metre of the mesh, and the range of values in the leaf's neighbourhood.
struct LeafSlope {
  Vec3 r, g, b;
  Rgb low, high;

  Rgb along(Vec3 offset) const { return {dot(r, offset), dot(g, offset), dot(b, offset)}; }
};

/// A leaf's neighbours across its edges, at most two across each, smooth ones only.
class SmoothNeighbours {
 public:
  SmoothNeighbours() = default;
  SmoothNeighbours(const PatchForest& forest, NodeIndex leaf);

  const NodeIndex* begin() const { return nodes_.data(); }
  const NodeIndex* end() const { return nodes_.data() + count_; }
  /// Some edge has no neighbour: a crease or the surface's end.
  bool at_crease() const { return at_crease_; }

 private:
  void add(NodeIndex node);

  std::array<NodeIndex, 8> nodes_;
  std::uint8_t count_ = 0;
  bool at_crease_ = false;
};

/// Neighbours of leaves, kept from one time to the next: a leaf's are the same as long as all of them are leaves. Borrows the
/// forest. One thread at a time.
class NeighbourTable {
 public:
  explicit NeighbourTable(const PatchForest& forest) : forest_(forest) {}
  /// In the order of `leaves`. Requires: leaves of the forest as it is now, each once. In parallel.
  std::vector<SmoothNeighbours> of(std::span<const NodeIndex> leaves);

 private:
  const PatchForest& forest_;
  std::vector<SmoothNeighbours> known_;  // by node
  std::vector<std::uint8_t> is_known_;
};

/// Weighted least squares over the neighbours; those where exactly nothing arrives take no part. `centre` and `value` are indexed
/// by node. Safe from any thread.
LeafSlope leaf_slope(const PatchForest& forest, NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                     std::span<const Rgb> value);

}  // namespace alvor
