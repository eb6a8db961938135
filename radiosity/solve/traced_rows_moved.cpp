// The part of TracedRows that takes moved roots: rays that ended on them or would meet them now are sent again.

#include "meshing/patch_place.h"
#include "radiosity/rays/ray_source.h"
#include "radiosity/rays/resent_rays.h"
#include "radiosity/solve/leaf_spheres.h"
#include "radiosity/solve/traced_rows.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>

namespace alvor {

namespace {

// Share of an origin's directions. An origin is hidden if more than half of its sixteen rays meet backs: what covers less than
// this seldom changes whether it is. Chosen.
constexpr double half_a_ray = 1.0 / 32;

Vec3 point_of(const PatchPoints& points, std::size_t o) { return {points.x[o], points.y[o], points.z[o]}; }

/// Mends one row. Where an origin is known to within a stratum only, as in rounds of rays after the first, the stratum's size is
/// allowed for when looking for rays in the way of an object, and the ray sent is off by as much.
class RowMender {
 public:
  RowMender(const LocalScene& scene, const BaseMesh& before, const Forests& forests, const MovedRoots& moved, RayBudget& budget)
      : scene_(scene), before_(before), moved_(moved), budget_(budget), spheres_(forests, scene.frame(), moved) {}

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
      const std::array from_local{static_cast<float>(from.x), static_cast<float>(from.y), static_cast<float>(from.z)};
      const double off = k < origins_per_patch ? 0 : stratum;
      const auto off_local = static_cast<float>(off / scene_.frame().metres_per_unit);
      for (const std::size_t last = hit + row.origin_hits[k]; hit < last; ++hit) {
        if (!leaves.empty() && spheres_.rays_pass_by(from_local, off_local, leaves[hit])) continue;  // as most do
        const bool was_moved = moved_.has(row.hits[hit].root_face());
        const BaseMesh& of_hit = was_moved ? before_ : scene_.mesh();
        const Vec3 end = centre_of(of_hit, shape_of(of_hit, row.hits[hit]));
        if (!was_moved && !moved_.may_meet_now(from_metres, end, off)) continue;
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
  const LocalScene& scene_;
  const BaseMesh& before_;
  const MovedRoots& moved_;
  RayBudget& budget_;
  LeafSpheres spheres_;
};

}  // namespace

/// Returns whether moved roots can change neither the hits nor the hidden origins of a row. May return false where that is so.
bool TracedRows::is_far_from(const MovedRoots& moved, NodeIndex row) const {
  return !may_reach(moved, row) && !may_hide_otherwise(moved, row);
}

/// Returns whether hidden origins of a row may be seen now, because of the backs that moved roots showed or show.
bool TracedRows::may_hide_otherwise(const MovedRoots& moved, NodeIndex row) const {
  if (rows_[row].hidden_origins == 0 || !moved.show_backs()) return false;
  const PatchShape shape = forests_.rows().shape(row);
  const RootPatch& root = scene_.mesh().roots()[shape.root];
  const BoundingBox box = box_of(scene_.mesh(), shape);
  return moved.are_in_front(root.corners[0], root.normal, true) &&
         moved.may_cover(half_a_ray, lerp(box.low, box.high, 0.5), length(box.high - box.low) / 2);
}

MendedRows TracedRows::note_moved(const BaseMesh& before, const MovedRoots& moved) {
  const bool may_mend = plan_.needs(Feature::refinement) && !plan_.needs(Feature::panes) && !plan_.needs(Feature::medium) &&
                        !directions_.has_weights();
  // Rays that were added since hits were looked up last have no leaves yet.
  const auto known_leaves = [this](NodeIndex row) {
    auto& leaves = hit_leaves_[row];
    return leaves.size() == rows_[row].hits.size() ? std::span(leaves) : std::span<NodeIndex>();
  };
  if (hit_boxes_) hit_boxes_->heed(scene_.mesh());
  const RowMender mender(scene_, before, forests_, moved, budget_);
  const std::vector<NodeIndex> rows = forests_.all_rows();
  std::vector<RowMender::Outcome> outcomes(rows.size(), RowMender::Outcome::unchanged);
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) {
    if (!is_traced_[rows[n]] || is_far_from(moved, rows[n])) return;
    TransportRow& row = rows_[rows[n]];
    const PatchShape shape = forests_.rows().shape(rows[n]);
    const RootPatch& root = scene_.mesh().roots()[shape.root];
    const PatchId id = forests_.rows().id(rows[n]);
    const bool is_beside = moved.are_in_front(root.corners[0], root.normal, moved.show_backs());
    // A row does not tell where those of its rays went that met no front.
    const bool has_unknown = !row.is_closed && !row.is_hidden() && is_beside;
    if (moved.has(shape.root) || moved.touch(box_of(scene_.mesh(), shape)) || (carry_light() && (!may_mend || has_unknown)) ||
        (may_hide_otherwise(moved, rows[n]) && !mender.is_hidden_as_before(shape, id, options_.seed, row)))
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
  note_hits(found.mended);
  std::erase_if(wanting_, [this](NodeIndex row) { return !is_traced_[row]; });
  return found;
}

}  // namespace alvor
