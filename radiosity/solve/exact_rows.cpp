// Replaces sampled rows by rows of exact form factors.

#include "radiosity/form_factors/form_factor_matrix.h"
#include "radiosity/rays/medium.h"
#include "radiosity/solve/traced_rows.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

namespace {

// Absolute accuracy aimed at for single form factors. Shadowed ones err more, their sums less. Chosen; half: the same, double:
// the same (docs/design/constants.md).
constexpr double accuracy = 1e-4;
// Most rows of a scene, and most shadowed patches seen from one patch, for which the edges of shadows are followed. With few and
// large patches common sample points err by percents (2 % around a block, tests/radiosity/known_boxes_test.cpp). With many,
// following takes a hundred times as long. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::size_t most_rows_followed = 32, most_shadows_followed = 32;

std::vector<Vec3> polygon_of(const BaseMesh& mesh, const PatchShape& shape) {
  const auto corners = corners_of(mesh, shape);
  return {corners.begin(), corners.begin() + shape.corner_count};
}

/// Returns the factor by which a row's form factors are multiplied. If no ray escaped they then sum to 1. Otherwise they are
/// averaged over the patch's visible part only, and sum to at most 1: if nearly all light is reflected, an excess of 1e-4 would
/// never end.
double scale_to_closure(std::span<const MatrixEntry> entries, double visible_share, bool is_closed) {
  double sum = 0;
  for (const MatrixEntry& entry : entries) sum += entry.value;
  if (sum <= 0) return 0;
  return is_closed ? 1 / sum : std::min(1 / visible_share, 1 / sum);
}

}  // namespace

// The rows were traced before, so their hidden origins are known. A form factor to a patch is spread over the patch's leaves by
// area. Exact rows have no origins and no noise.
void TracedRows::make_exact() {
  const BaseMesh& mesh = forests_.mesh();
  const std::vector<NodeIndex> rows = forests_.all_rows();
  std::vector<std::vector<Vec3>> polygons;
  std::vector<std::vector<NodeIndex>> leaves(rows.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    polygons.push_back(polygon_of(mesh, forests_.rows().shape(rows[n])));
    forests_.append_leaves_of_row(rows[n], leaves[n]);
  }
  const FacePolygons patches(std::move(polygons));
  const Blockers blockers(mesh);
  const FormFactorRows form_factors(patches, blockers, accuracy, rows.size() <= most_rows_followed ? most_shadows_followed : 0);
  const Medium medium{mesh.absorption()};
  tbb::parallel_for(std::size_t{0}, rows.size(), [&](std::size_t n) {
    TransportRow& row = rows_[rows[n]];
    if (row.is_hidden() || budget_.is_out()) return;
    row.origin_hits.clear();
    row.rays = 1;
    if (!is_own(rows[n])) return;
    const auto entries = form_factors.row(static_cast<std::uint32_t>(n));
    const double scale = scale_to_closure(entries, row.visible_share(), row.is_closed);
    row.hits.clear();
    row.hit_weight.clear();
    for (const MatrixEntry& entry : entries)
      for (const NodeIndex leaf : leaves[entry.to]) {
        const double share = scale * forests_.leaf_area(leaf) / patches.area(entry.to);
        const Rgb dimmed = medium.transmittance(length(forests_.leaf_centres()[leaf] - forests_.row_centres()[rows[n]]));
        row.hits.push_back(forests_.leaves().id(leaf));
        row.hit_weight.push_back(narrow(entry.value * share * dimmed));
      }
    hit_leaves_[rows[n]].clear();
  });
  note_change(rows);
}

}  // namespace alvor
