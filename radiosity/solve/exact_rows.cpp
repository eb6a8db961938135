// Rows of exact form factors in the place of sampled ones.

#include "radiosity/form_factors/form_factor_matrix.h"
#include "radiosity/rays/medium.h"
#include "radiosity/solve/traced_rows.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace alvor {

namespace {

constexpr double accuracy = 1e-4;  // of single factors; shadowed ones err more, their sums less
// The edges of shadows are followed where patches are few and large: there common points err by percents. Among many patches it
// would take a hundred times as long.
constexpr std::size_t most_rows_followed = 32, most_shadows_followed = 32;

std::vector<Vec3> polygon_of(const BaseMesh& mesh, const PatchShape& shape) {
  const auto corners = corners_of(mesh, shape);
  return {corners.begin(), corners.begin() + shape.corner_count};
}

/// What keeps the part of a patch that no solid stands on as bright as it is though the rest receives nothing, and makes the
/// factors of a row sum to 1 where no ray escaped, and to no more elsewhere: where nearly all is reflected an excess of 1e-4
/// would never end.
double scale_to_closure(std::span<const MatrixEntry> entries, double visible_share, bool is_closed) {
  double sum = 0;
  for (const MatrixEntry& entry : entries) sum += entry.value;
  if (sum <= 0) return 0;
  return is_closed ? 1 / sum : std::min(1 / visible_share, 1 / sum);
}

}  // namespace

// Rays were sent all the same, to tell what is hidden. A patch's form factor is spread over its leaves by area. The row is known
// exactly, so it has no origins and no noise.
void TracedRows::make_exact() {
  const BaseMesh& mesh = forests_.mesh();
  const std::vector<NodeIndex> rows = forests_.rows().leaves();
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
    const auto entries = form_factors.row(static_cast<std::uint32_t>(n));
    const double scale = scale_to_closure(entries, row.visible_share(), row.is_closed);
    row.hits.clear();
    row.hit_weight.clear();
    row.origin_hits.clear();
    row.rays = 1;
    for (const MatrixEntry& entry : entries)
      for (const NodeIndex leaf : leaves[entry.to]) {
        const double share = scale * forests_.leaf_area(leaf) / patches.area(entry.to);
        const Rgb dimmed = medium.transmittance(length(forests_.leaf_centres()[leaf] - forests_.row_centres()[rows[n]]));
        row.hits.push_back(forests_.leaves().id(leaf));
        row.hit_weight.push_back(narrow(entry.value * share * dimmed));
      }
    hit_leaves_[rows[n]].clear();
  });
}

}  // namespace alvor
