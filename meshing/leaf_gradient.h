#pragma once
// Gradients of leaf values, from differences between neighbouring leaves.

#include "meshing/patch_forest.h"
#include "solution/relative_light.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The gradient of each band in the leaf's plane, per metre, and the smallest and largest value among the leaf and its
/// neighbours. `Value` is Rgb or RelativeLight.
template <class Value>
struct LeafSlopeOf {
  Vec3 r, g, b;
  Value low, high;

  Value along(Vec3 offset) const { return {dot(r, offset), dot(g, offset), dot(b, offset)}; }
};
using LeafSlope = LeafSlopeOf<Rgb>;
using RelativeSlope = LeafSlopeOf<RelativeLight>;

/// A leaf's neighbours across its edges: at most two across each edge, none across creases.
class SmoothNeighbours {
 public:
  SmoothNeighbours() = default;
  SmoothNeighbours(const PatchForest& forest, NodeIndex leaf);

  const NodeIndex* begin() const { return nodes_.data(); }
  const NodeIndex* end() const { return nodes_.data() + count_; }
  /// Returns whether some edge has no neighbour: a crease or the end of the surface.
  bool at_crease() const { return at_crease_; }

 private:
  void add(NodeIndex node);

  std::array<NodeIndex, 8> nodes_;
  std::uint8_t count_ = 0;
  bool at_crease_ = false;
};

/// Caches the neighbours of leaves. An entry stays valid as long as all neighbours in it are leaves. Borrows the forest. One
/// thread at a time.
class NeighbourTable {
 public:
  explicit NeighbourTable(const PatchForest& forest) : forest_(forest) {}
  /// Returns the neighbours of each of `leaves`, in that order; computes in parallel. Requires: leaves of the forest as it is
  /// now, each once.
  std::vector<SmoothNeighbours> of(std::span<const NodeIndex> leaves);
  /// To be called when the forest's nodes have other numbers.
  void forget() { known_.clear(), is_known_.clear(); }

 private:
  const PatchForest& forest_;
  std::vector<SmoothNeighbours> known_;  // by node
  std::vector<std::uint8_t> is_known_;
};

/// Returns the gradient at `leaf` by weighted least squares over its neighbours. Neighbours of exactly zero value take no part.
/// `centre` and `value` are indexed by node. Safe from any thread.
LeafSlope leaf_slope(const PatchForest& forest, NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                     std::span<const Rgb> value);
RelativeSlope leaf_slope(const PatchForest& forest, NodeIndex leaf, const SmoothNeighbours& neighbours,
                         std::span<const Vec3> centre, std::span<const RelativeLight> value);

}  // namespace alvor
