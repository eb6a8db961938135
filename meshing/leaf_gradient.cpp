#include "meshing/leaf_gradient.h"

#include "meshing/tangent_frame.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>

namespace alvor {

namespace {

/// The normal equations of a least-squares gradient g: sum w (d d^T) g = sum w d dv, for each band.
template <class Value>
struct NormalEquations {
  double ss = 0, st = 0, tt = 0;
  Value s, t;

  void add(double ds, double dt, const Value& difference) {
    const double w = 1 / (ds * ds + dt * dt);
    ss += w * ds * ds;
    st += w * ds * dt;
    tt += w * dt * dt;
    s += (w * ds) * difference;
    t += (w * dt) * difference;
  }
  /// Returns the slope along each axis; zero along a direction without neighbours.
  std::pair<Value, Value> solve() const {
    const double ridge = 1e-6 * (ss + tt);
    if (!(ridge > 0)) return {};
    const double a = ss + ridge, d = tt + ridge, inverse = 1 / (a * d - st * st);
    return {inverse * (d * s - st * t), inverse * (a * t - st * s)};
  }
};

template <class Value>
LeafSlopeOf<Value> slope_of(const PatchForest& forest, NodeIndex leaf, const SmoothNeighbours& neighbours,
                            std::span<const Vec3> centre, std::span<const Value> value) {
  LeafSlopeOf<Value> slope{{}, {}, {}, value[leaf], value[leaf]};
  if (value[leaf].is_zero()) return slope;
  const TangentFrame frame(forest.mesh().roots()[forest.id(leaf).root_face()].normal);
  NormalEquations<Value> equations;
  for (const NodeIndex other : neighbours) {
    const Vec3 d = centre[other] - centre[leaf];
    if (value[other].is_zero() || dot(d, d) == 0) continue;
    equations.add(dot(d, frame.s), dot(d, frame.t), value[other] - value[leaf]);
    slope.low = lower(slope.low, value[other]);
    slope.high = upper(slope.high, value[other]);
  }
  const auto [s, t] = equations.solve();
  slope.r = s.r * frame.s + t.r * frame.t;
  slope.g = s.g * frame.s + t.g * frame.t;
  slope.b = s.b * frame.s + t.b * frame.t;
  return slope;
}

}  // namespace

SmoothNeighbours::SmoothNeighbours(const PatchForest& forest, NodeIndex leaf) {
  const PatchShape shape = forest.shape(leaf);
  for (int e = 0; e < shape.corner_count; ++e) {
    if (const auto root_edge = root_edge_of(shape, e)) {
      const auto across = forest.mesh().across(shape.root, *root_edge);
      if (!across || !across->smooth) {
        at_crease_ = true;
        continue;
      }
    }
    // On either side of the middle, and within the inner two of four slabs.
    const NodeIndex near = forest.leaf_across(shape, e, 0.375), far = forest.leaf_across(shape, e, 0.625);
    add(near);
    if (far != near) add(far);
  }
}

void SmoothNeighbours::add(NodeIndex node) {
  if (node != PatchForest::no_node) nodes_[count_++] = node;
}

std::vector<SmoothNeighbours> NeighbourTable::of(std::span<const NodeIndex> leaves) {
  known_.resize(forest_.node_count());
  is_known_.resize(forest_.node_count());
  std::vector<SmoothNeighbours> all(leaves.size());
  tbb::parallel_for(std::size_t{0}, leaves.size(), [&](std::size_t n) {
    const NodeIndex leaf = leaves[n];
    assert(forest_.is_leaf(leaf));
    const bool is_fresh =
        is_known_[leaf] && std::ranges::all_of(known_[leaf], [this](NodeIndex other) { return forest_.is_leaf(other); });
    if (!is_fresh) known_[leaf] = SmoothNeighbours(forest_, leaf);
    is_known_[leaf] = 1;
    all[n] = known_[leaf];
  });
  return all;
}

LeafSlope leaf_slope(const PatchForest& forest, NodeIndex leaf, const SmoothNeighbours& neighbours, std::span<const Vec3> centre,
                     std::span<const Rgb> value) {
  return slope_of(forest, leaf, neighbours, centre, value);
}

RelativeSlope leaf_slope(const PatchForest& forest, NodeIndex leaf, const SmoothNeighbours& neighbours,
                         std::span<const Vec3> centre, std::span<const RelativeLight> value) {
  return slope_of(forest, leaf, neighbours, centre, value);
}

}  // namespace alvor
