// Finds what sixteen points of a leaf see that its neighbours do not tell, and how a split would follow it.

#include "radiosity/estimate/axis_contrast.h"
#include "radiosity/solve/pass.h"

#include <bit>

namespace alvor {

namespace {

// Share of the mean square of values that rounding may leave of their variance.
constexpr double rounding = 1e-12;

double squared(double x) { return x * x; }

/// dot(slope, point - origin) for the points of a root: places on it are linear in its corners.
class SlopeOnRoot {
 public:
  SlopeOnRoot(const RootPatch& root, Vec3 slope, Vec3 origin) {
    const auto at_corner = [&](std::size_t n) { return dot(slope, root.corners[n] - origin); };
    const std::size_t across = root.corner_count == 3 ? 2 : 3;
    first_ = at_corner(0);
    by_u_ = at_corner(1) - first_;
    by_v_ = at_corner(across) - first_;
    if (root.corner_count == 4) by_both_ = at_corner(2) - first_ - by_u_ - by_v_;
  }
  /// Returns the value at RootPatch::at().
  double at(Uv at) const { return first_ + at.u * by_u_ + at.v * (by_v_ + at.u * by_both_); }

 private:
  double first_ = 0, by_u_ = 0, by_v_ = 0, by_both_ = 0;
};

}  // namespace

/// Returns the mean square deviation of the irradiance at a leaf's visible origins from a plane with the leaf's slope through
/// their mean, less the noise of shadow rays, at least 0; in emission units squared.
Pass::Contrast Pass::squared_contrast(std::size_t place_of_leaf, Vec3 slope) const {
  const Forests& forests = state_.forests;
  const NodeIndex leaf = system_->leaves()[place_of_leaf], row = system_->row_of(place_of_leaf);
  const DirectLight& direct = state_.direct[leaf];
  const std::uint16_t hidden = state_.hidden_origins(leaf, row);
  const PatchShape shape = forests.leaves().shape(leaf);
  const RootPatch& root = state_.mesh.roots()[shape.root];
  const SlopeOnRoot plane(root, slope, forests.leaf_centres()[leaf]);
  double sum = 0, squares = 0;
  AxisContrast by_axis(shape);
  for (int o = 0; o < origins_per_patch; ++o) {
    if (hidden >> o & 1) continue;
    const Uv at = shape.stratum_centre(o);
    const double by_rows = state_.field.at(row, root.at(at.u, at.v)).mean();
    const double above_plane = direct.at_origin[o] + by_rows - plane.at(at);
    sum += above_plane, squares += squared(above_plane);
    by_axis.add(o, above_plane);
  }
  const int visible = origins_per_patch - std::popcount(hidden);
  if (visible == 0) return {};
  const double square = squares / visible, contrast = square - squared(sum / visible) - noise_of_origins * direct.origin_variance;
  const Split split = hidden != 0 ? AxisContrast::along_outline(shape, hidden) : by_axis.best_split(direct.origin_variance);
  return {contrast > rounding * square ? contrast : 0, split};
}

}  // namespace alvor
