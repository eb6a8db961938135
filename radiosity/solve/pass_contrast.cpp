// Finds what sixteen points of a leaf see that its neighbours do not tell, and how a split would follow it.

#include "radiosity/estimate/axis_contrast.h"
#include "radiosity/solve/pass.h"

#include <bit>

namespace alvor {

namespace {

// Share of the mean square of values that rounding may leave of their variance.
constexpr double rounding = 1e-12;

double squared(double x) { return x * x; }

}  // namespace

/// Returns the mean square deviation of the irradiance at a leaf's visible origins from a plane with the leaf's slope through
/// their mean, less the noise of shadow rays, at least 0; in emission units squared.
Pass::Contrast Pass::squared_contrast(std::size_t place_of_leaf, const RelativeSlope& slope) const {
  const Forests& forests = state_.forests;
  const NodeIndex leaf = system_->leaves()[place_of_leaf], row = system_->row_of(place_of_leaf);
  const DirectLight& direct = state_.direct[leaf];
  const std::uint16_t hidden = state_.hidden_origins(leaf, row);
  const PatchShape shape = forests.leaves().shape(leaf);
  const auto place = [&](Uv at) { return state_.mesh.roots()[shape.root].at(at.u, at.v); };
  const Vec3 steepest = (slope.r + slope.g + slope.b) / 3;
  double sum = 0, squares = 0;
  AxisContrast by_axis(shape);
  for (int k = 0; k < 4; ++k) {
    if ((hidden >> 4 * k & 0xf) == 0xf) continue;
    const double by_rows = state_.field.at(row, place(shape.quarter_centre(k))).mean();
    for (int o = 0; o < 4; ++o) {
      if (hidden >> (4 * k + o) & 1) continue;
      const Vec3 offset = place(shape.stratum_centre(4 * k + o)) - forests.leaf_centres()[leaf];
      const double above_plane = direct.at_origin[4 * k + o] + by_rows - dot(steepest, offset);
      sum += above_plane, squares += squared(above_plane);
      by_axis.add(4 * k + o, above_plane);
    }
  }
  const int visible = origins_per_patch - std::popcount(hidden);
  if (visible == 0) return {};
  const double square = squares / visible, contrast = square - squared(sum / visible) - noise_of_origins * direct.origin_variance;
  const Split split = hidden != 0 ? AxisContrast::along_outline(shape, hidden) : by_axis.best_split(direct.origin_variance);
  return {contrast > rounding * square ? contrast : 0, split};
}

/// Changes the candidates that split rows. A row whose place is one leaf is to be split as the leaf, if the light at the leaf's
/// sixteen points asks for slabs: direct light tells the direction of a line more surely than the noisy rays of a row.
/// `splits` is by place of the leaf in the system's list.
void Pass::split_rows_as_leaves(std::span<const Split> splits) {
  std::vector<Split> by_leaf(state_.forests.leaves().node_count());
  for (std::size_t n = 0; n < splits.size(); ++n) by_leaf[system_->leaves()[n]] = splits[n];
  for (Candidate& candidate : candidates_) {
    if (candidate.kind != Candidate::Kind::split_row) continue;
    const Split by_light = by_leaf[state_.forests.leaf_node_of(candidate.patch)];
    if (by_light != Split::quarters) candidate.split = by_light;
  }
}

}  // namespace alvor
