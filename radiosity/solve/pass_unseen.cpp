// Finds light on parts of rows that their origins do not see: slivers beside solids, and strips along the openings of gaps.

#include "radiosity/solve/pass.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

namespace alvor {

namespace {

// Squared error along the opening of a gap between parallel faces, per length, where the faces are shown dark: the irradiance at
// depth x of a gap as wide as g is E/2 (1 - x / sqrt(x2 + g2)) if E arrives outside of it, and its square, integrated over x, is
// E2 g times this.
constexpr double error_of_opening = (2 - std::numbers::pi / 2) / 4;
// Least width of a row, in multiples of the gap before it, that may miss light at the opening. Chosen: its outermost origins lie
// an eighth of its width from the edge, and at that depth of a gap half as wide there is three quarters of the light at the edge.
constexpr double widths_of_gap = 2;

/// Returns whether the surface beyond an edge of a root lies below the root's plane.
bool falls_away(const BaseMesh& mesh, std::uint32_t root, int edge) {
  const auto across = mesh.across(root, edge);
  if (!across || across->smooth) return false;
  const RootPatch& beyond = mesh.roots()[across->root];
  Vec3 middle;
  for (int c = 0; c < beyond.corner_count; ++c) middle += beyond.corners[c] / double(beyond.corner_count);
  return dot(middle - mesh.roots()[root].corners[0], mesh.roots()[root].normal) < 0;
}

/// The leaves of some patches.
class LeavesOfPatches {
 public:
  LeavesOfPatches(const PassSystem& system, std::size_t leaf_nodes, std::span<const std::uint32_t> patches)
      : contains_(leaf_nodes), number_(leaf_nodes) {
    for (std::uint32_t k = 0; k < patches.size(); ++k)
      for (const NodeIndex leaf : system.leaves_of(patches[k])) contains_[leaf] = true, number_[leaf] = k;
  }

  bool contains(NodeIndex leaf) const { return contains_[leaf]; }
  /// Returns the place of the leaf's patch among the patches. Requires: contains(leaf).
  std::uint32_t number_of(NodeIndex leaf) const { return number_[leaf]; }

 private:
  std::vector<bool> contains_;  // most hits ask no more: small enough for the first cache
  std::vector<std::uint32_t> number_;
};

/// What one row sees of the patches with these leaves: the weights of the rays that end on each.
class SeenByRow {
 public:
  struct Seen {
    std::uint32_t patch;
    double weight, squared_weight;
  };

  SeenByRow(const LeavesOfPatches& leaves, std::span<const NodeIndex> hit, std::span<const RgbF> weight) {
    for (std::size_t h = 0; h < hit.size(); ++h)
      if (leaves.contains(hit[h])) add(leaves.number_of(hit[h]), weight.empty() ? 1 : weight[h].mean());
  }
  std::span<const Seen> patches() const { return patches_; }

 private:
  void add(std::uint32_t patch, double weight) {
    auto seen = std::ranges::find(patches_, patch, &Seen::patch);
    if (seen == patches_.end()) return patches_.push_back({patch, weight, weight * weight});
    seen->weight += weight;
    seen->squared_weight += weight * weight;
  }

  std::vector<Seen> patches_;
};

}  // namespace

/// Sets OriginMisfit::unseen of patches whose origins are all hidden, but on which rays end: so a part of them can be seen, such
/// as the floor of a slot between two cupboards. They are shown dark, and the rows that see them lack their light. Of a row of n
/// rays, k of which end on such a patch, that is k/n of the patch's radiosity. Its square is found from k (k - 1), whose mean is
/// the square of the mean of k (Poisson), so that neither noise nor a ray that slipped through a seam counts. The patch is taken
/// to be as bright as the rows that see it. `irradiance` is by row node.
void Pass::find_slivers(std::span<const double> irradiance) {
  const auto patches = system_->patches();
  std::vector<std::uint32_t> hidden;
  double whole_area = 0, brightest = 0;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    whole_area += patches[p].area;
    brightest = std::max(brightest, irradiance[system_->rows()[p]]);
    if (patches[p].row->is_hidden()) hidden.push_back(p);
  }
  const double unit = whole_area * brightest * brightest * 0x1p-50;  // of squared errors in fixed point: no order matters
  if (hidden.empty() || unit == 0) return;
  const LeavesOfPatches leaves(*system_, state_.forests.leaves().node_count(), hidden);
  std::vector<std::uint64_t> squares(hidden.size());
  tbb::parallel_for(std::size_t{0}, patches.size(), [&](std::size_t p) {
    const NodeIndex node = system_->rows()[p];
    const TransportRow& row = state_.rows[node];
    const double light_of_ray = std::max(0.0, irradiance[node]) / std::max(1u, row.ray_count());
    const SeenByRow seen(leaves, state_.rows.leaves_hit(node), row.hit_weight);
    for (const auto& [k, weight, squared_weight] : seen.patches()) {
      const double square = visible_area(p) * (weight * weight - squared_weight) * light_of_ray * light_of_ray;
      std::atomic_ref(squares[k]).fetch_add(static_cast<std::uint64_t>(std::max(0.0, square) / unit), std::memory_order_relaxed);
    }
  });
  state_.ranks.sum(squares);
  for (std::size_t k = 0; k < hidden.size(); ++k) {
    const double reflectance = state_.forests.reflectance(system_->leaves_of(hidden[k])[0]).mean();
    misfits_[hidden[k]] = {};
    misfits_[hidden[k]].unseen.square = reflectance * reflectance * static_cast<double>(squares[k]) * unit;
  }
}

/// Returns the error of a row at those edges of its face beyond which a brighter face falls away, if the row is in a gap: the
/// side of a book that stands a little apart from the next. Light reaches into a gap about as far as the gap is wide, and the
/// origins of a wider row hardly see it.
SplitError Pass::error_at_openings(NodeIndex row, std::span<const double> irradiance) const {
  const PatchForest& forest = state_.forests.rows();
  const PatchShape shape = forest.shape(row);
  const auto corners = corners_of(state_.mesh, shape);
  std::optional<double> gap;
  double largest = 0;
  SplitError error;
  for (int e = 0; e < shape.corner_count; ++e) {
    const auto edge = root_edge_of(shape, e);
    if (!edge || !falls_away(state_.mesh, shape.root, *edge)) continue;
    const double brighter = irradiance[forest.leaf_across(shape, e, 0.5)] - irradiance[row];
    if (brighter <= irradiance[row]) continue;
    if (!gap) gap = gap_before(row);
    const double along = length(corners[(e + 1) % shape.corner_count] - corners[e]);
    if (*gap * widths_of_gap * along > area_of(state_.mesh, shape)) continue;
    const double square = error_of_opening * brighter * brighter * *gap * along;
    error.square += square;
    if (square <= largest) continue;
    largest = square;
    if (shape.corner_count == 4) error.split = e % 2 == 1 ? Split::slabs_along_u : Split::slabs_along_v;
  }
  return error;
}

/// Returns the height above a row's plane, in metres, below which half of its rays end: the width of the gap that it is in, if it
/// is in one. Infinite if most of them leave the scene. Requires: the row's hits are on this rank.
double Pass::gap_before(NodeIndex row) const {
  const TransportRow& rays = state_.rows[row];
  const Vec3 normal = state_.mesh.roots()[state_.forests.rows().id(row).root_face()].normal,
             centre = state_.forests.row_centres()[row];
  const std::size_t middle = rays.ray_count() / 2;
  if (rays.hits.size() <= middle) return std::numeric_limits<double>::infinity();
  std::vector<double> heights;
  for (const PatchId hit : rays.hits) heights.push_back(dot(centre_of(state_.mesh, shape_of(state_.mesh, hit)) - centre, normal));
  std::ranges::nth_element(heights, heights.begin() + static_cast<std::ptrdiff_t>(middle));
  return std::max(0.0, heights[middle]);
}

}  // namespace alvor
