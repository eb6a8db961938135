#pragma once
// Slopes of what the leaves hold, from differences with their neighbours.

#include "meshing/patch_forest.h"

#include <array>
#include <span>
#include <vector>

namespace alvor {

/// Slope per band along the leaf's plane, per metre of the mesh, and the range of values in the leaf's neighbourhood.
struct LeafSlope {
  Vec3 r, g, b;
  Rgb low, high;

  Rgb along(Vec3 offset) const { return {dot(r, offset), dot(g, offset), dot(b, offset)}; }
};

/// Weighted least squares over the leaves that share an edge, at most two across each; never across a crease. Neighbours where exactly
/// nothing arrives take no part. `centre` and `value` are indexed by node; slopes come in the order of `leaves`.
std::vector<LeafSlope> leaf_slopes(const PatchForest& forest, std::span<const NodeIndex> leaves, std::span<const Vec3> centre,
                                   std::span<const Rgb> value);

/// The leaf's neighbours across its edges, each once, smooth ones only. True if some edge has none: a crease or the surface's end.
bool smooth_neighbours(const PatchForest& forest, NodeIndex leaf, std::vector<NodeIndex>& neighbours);

}  // namespace alvor
