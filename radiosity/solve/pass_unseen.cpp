// Finds errors in places that the origins of rows do not see: slivers beside solids, and strips along the openings of gaps.

#include "radiosity/solve/pass.h"

#include <algorithm>
#include <cstdint>
#include <numbers>
#include <optional>

namespace alvor {

namespace {

// Squared error along the opening of a gap between parallel faces, per length, where the faces are shown dark: the irradiance at
// depth x of a gap as wide as g is E/2 (1 - x / sqrt(x2 + g2)) if E arrives outside of it, and its square, integrated over x, is
// E2 g times this.
constexpr double error_of_opening = (2 - std::numbers::pi / 2) / 4;
// Least width of a row, in multiples of the gap before it, that may miss light at the opening. Its outermost origins lie an
// eighth of its width from the edge, and at that depth of a gap a third as wide there is two thirds of the light at the edge.
// Measured: with 2 the furnished room asked for 2 % takes 8 % more leaves and rays for the same error, with 4 as many.
constexpr double widths_of_gap = 3;

/// Returns whether the surface beyond an edge of a root lies below the root's plane.
bool falls_away(const BaseMesh& mesh, std::uint32_t root, int edge) {
  const auto across = mesh.across(root, edge);
  if (!across || across->smooth) return false;
  const RootPatch& beyond = mesh.roots()[across->root];
  Vec3 middle;
  for (int c = 0; c < beyond.corner_count; ++c) middle += beyond.corners[c] / double(beyond.corner_count);
  return dot(middle - mesh.roots()[root].corners[0], mesh.roots()[root].normal) < 0;
}

}  // namespace

/// Finds the light that rows lack because their rays end on patches whose origins are all hidden, which are shown dark: the share
/// of these rays, times the radiosity of the sliver that they see, which is taken to be as bright as the row. Sets `lacking_` of
/// the rows, and OriginMisfit::unseen of the patches, which must be split for it. `irradiance` is by row node.
void Pass::find_slivers(std::span<const double> irradiance) {
  const auto rows = system_->rows();
  double whole_area = 0, brightest = 0;
  std::vector<std::uint32_t> patch_of(state_.forests.rows().node_count());
  for (std::uint32_t p = 0; p < rows.size(); ++p) {
    patch_of[rows[p]] = p;
    whole_area += system_->patches()[p].area;
    brightest = std::max(brightest, irradiance[rows[p]]);
    if (state_.rows[rows[p]].is_hidden()) misfits_[p] = {};
  }
  const auto views = state_.slivers.find(state_.forests, state_.rows);
  const double unit = whole_area * brightest * brightest * 0x1p-50;
  if (unit == 0 || (views.empty() && state_.ranks.is_alone())) return;
  // In fixed point: ranks have different views of one patch.
  std::vector<std::uint64_t> squares(2 * rows.size());
  for (const auto& [row, there, squared_share] : views) {
    const std::uint32_t hidden = patch_of[there], from = patch_of[row];
    const double light = system_->patches()[hidden].reflectance.mean() * std::max(0.0, irradiance[row]);
    const auto square = static_cast<std::uint64_t>(visible_area(from) * squared_share * light * light / unit);
    squares[2 * hidden] += square, squares[2 * from + 1] += square;
  }
  state_.ranks.sum(squares);
  for (std::size_t p = 0; p < rows.size(); ++p) {
    if (squares[2 * p] > 0) misfits_[p].unseen.square = static_cast<double>(squares[2 * p]) * unit;
    if (squares[2 * p + 1] > 0) lacking_[p] = static_cast<double>(squares[2 * p + 1]) * unit;
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
    if (!gap) gap = state_.rows.gap_before(row);
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

}  // namespace alvor
