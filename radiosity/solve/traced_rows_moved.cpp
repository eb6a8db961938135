// The part of TracedRows that takes moved roots: rays that ended on them or would meet them now are sent again.

#include "meshing/patch_place.h"
#include "radiosity/rays/ray_source.h"
#include "radiosity/rays/resent_rays.h"
#include "radiosity/solve/traced_rows.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace alvor {

namespace {

Vec3 point_of(const PatchPoints& points, std::size_t o) { return {points.x[o], points.y[o], points.z[o]}; }

/// Returns how far the corners of each leaf node, split or not, are from its centre at most, metres.
std::vector<double> radii_of_leaves(const Forests& forests) {
  const PatchForest& leaves = forests.leaves();
  std::vector<double> radius(leaves.node_count());
  tbb::parallel_for(NodeIndex{0}, static_cast<NodeIndex>(radius.size()), [&](NodeIndex node) {
    const PatchShape shape = leaves.shape(node);
    const auto corners = corners_of(forests.mesh(), shape);
    for (std::size_t c = 0; c < static_cast<std::size_t>(shape.corner_count); ++c)
      radius[node] = std::max(radius[node], length(corners[c] - forests.leaf_centres()[node]));
  });
  return radius;
}

/// Mends one row. Where an origin is known to within a stratum only, as in rounds of rays after the first, the stratum's size is
/// allowed for when looking for rays in the way of an object, and the ray sent is off by as much.
class RowMender {
 public:
  RowMender(const LocalScene& scene, const BaseMesh& before, const Forests& forests, const MovedRoots& moved, RayBudget& budget)
      : scene_(scene),
        before_(before),
        forests_(forests),
        moved_(moved),
        budget_(budget),
        leaf_radius_(radii_of_leaves(forests)) {}

  enum class Outcome { unchanged, mended, lost };
  /// Returns whether the hidden origins of a row are still hidden, as far as one ray from each of them tells. Inside a solid that
  /// has not moved each ray meets a back.
  bool is_hidden_as_before(const PatchShape& shape, PatchId patch, std::uint64_t seed, const TransportRow& row) const {
    RandomStream random(seed, patch);
    const std::uint16_t backs = meet_backs(scene_, shape.root, sample_points(scene_, shape, random), budget_);
    return (row.hidden_origins & ~backs) == 0;
  }
  /// Sends stale rays again, and begins the look-up of the leaves that they find at the roots. The row is lost, and unchanged, if
  /// one of them meets no front now: which origins are hidden may be otherwise. Requires: the row's hits have places, and it
  /// comes from rays through nothing that weakens them; `leaves` has the leaf node that each hit found, or nothing.
  Outcome mend(const PatchShape& shape, PatchId patch, std::uint64_t seed, TransportRow& row, std::span<NodeIndex> leaves) const {
    assert(leaves.empty() || leaves.size() == row.hits.size());
    RandomStream random(seed, patch);
    const PatchPoints points = sample_points(scene_, shape, random);
    const auto corners = corners_of(scene_.mesh(), shape);
    const double stratum = (length(corners[2] - corners[0]) + length(corners[1] - corners[0])) / 2;
    std::vector<std::size_t> stale;
    std::vector<ResentRay> rays;
    for (std::size_t k = 0, hit = 0; k < row.origin_hits.size(); ++k) {
      if (row.origin_hits[k] == TransportRow::not_sampled) continue;
      const Vec3 from = point_of(points, k % origins_per_patch), from_metres = scene_.frame().to_metres(from);
      for (const std::size_t last = hit + row.origin_hits[k]; hit < last; ++hit) {
        const bool was_moved = moved_.has(row.hits[hit].root_face()), is_exact = k < origins_per_patch;
        if (!was_moved && !leaves.empty() && passes_by(from_metres, is_exact ? 0 : stratum, leaves[hit])) continue;
        const BaseMesh& of_hit = was_moved ? before_ : scene_.mesh();
        const Vec3 end = centre_of(of_hit, shape_of(of_hit, row.hits[hit]));
        if (!was_moved && !moved_.may_meet_now(from_metres, end, is_exact ? 0 : stratum)) continue;
        stale.push_back(hit);
        rays.push_back({from, scene_.frame().to_local(end)});
      }
    }
    if (stale.empty()) return Outcome::unchanged;
    const auto ends = resend(scene_, rays, scene_.mesh().roots()[shape.root].normal, budget_);
    if (!std::ranges::all_of(ends, [](const auto& end) { return end.has_value(); })) return Outcome::lost;
    for (std::size_t n = 0; n < stale.size(); ++n) {
      row.hits[stale[n]] = *ends[n];
      if (!leaves.empty()) leaves[stale[n]] = ends[n]->root_face();  // the first nodes are the roots
    }
    return Outcome::mended;
  }

 private:
  /// Returns whether a ray to any point of a leaf passes by all places where moved roots are now, which is soon found: most do.
  bool passes_by(Vec3 from, double radius, NodeIndex leaf) const {
    return !moved_.may_meet_now(from, forests_.leaf_centres()[leaf], radius + leaf_radius_[leaf]);
  }

  const LocalScene& scene_;
  const BaseMesh& before_;
  const Forests& forests_;
  const MovedRoots& moved_;
  RayBudget& budget_;
  std::vector<double> leaf_radius_;  // by leaf node
};

}  // namespace

MendedRows TracedRows::note_moved(const BaseMesh& before, const MovedRoots& moved) {
  const bool may_mend = plan_.needs(Feature::refinement) && !plan_.needs(Feature::panes) && !plan_.needs(Feature::medium) &&
                        !directions_.has_weights();
  // Rays that were added since hits were looked up last have no leaves yet.
  const auto known_leaves = [this](NodeIndex row) {
    auto& leaves = hit_leaves_[row];
    return leaves.size() == rows_[row].hits.size() ? std::span(leaves) : std::span<NodeIndex>();
  };
  const RowMender mender(scene_, before, forests_, moved, budget_);
  const std::vector<NodeIndex> rows = forests_.rows().leaves();
  std::vector<RowMender::Outcome> outcomes(rows.size(), RowMender::Outcome::unchanged);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) {
    if (!is_traced_[rows[n]]) return;
    TransportRow& row = rows_[rows[n]];
    const PatchShape shape = forests_.rows().shape(rows[n]);
    const RootPatch& root = scene_.mesh().roots()[shape.root];
    const PatchId id = forests_.rows().id(rows[n]);
    const bool is_beside = moved.are_in_front(root.corners[0], root.normal, moved.show_backs());
    // A row does not tell where those of its rays went that met no front.
    const bool has_unknown = !row.is_closed && !row.is_hidden() && is_beside;
    const bool may_hide_otherwise = row.hidden_origins != 0 && is_beside && moved.show_backs();
    if (moved.has(shape.root) || moved.touch(box_of(scene_.mesh(), shape)) || (carry_light() && (!may_mend || has_unknown)) ||
        (may_hide_otherwise && !mender.is_hidden_as_before(shape, id, options_.seed, row)))
      outcomes[n] = RowMender::Outcome::lost;
    else if (carry_light() && moved.are_in_front(root.corners[0], root.normal, true))
      outcomes[n] = mender.mend(shape, id, options_.seed, row, known_leaves(rows[n]));
  });
  MendedRows found;
  for (std::size_t n = 0; n < rows.size(); ++n) {
    if (outcomes[n] == RowMender::Outcome::mended) found.mended.push_back(rows[n]), found_among_[rows[n]] = 0;
    if (outcomes[n] != RowMender::Outcome::lost) continue;
    forget(rows[n]);
    is_traced_[rows[n]] = false;
    guides_.erase(rows[n]);
    found.lost.push_back(rows[n]);
  }
  std::erase_if(wanting_, [this](NodeIndex row) { return !is_traced_[row]; });
  return found;
}

}  // namespace alvor
