#pragma once
// Form factors between polygons with blockers between them.

#include "radiosity/form_factors/polygon_form_factor.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// The parts of blockers that stand between two polygons.
class Obstruction {
 public:
  /// Keeps the part of each blocker inside the convex hull of `from` and `to`. Blockers block from both sides; those in the plane
  /// of `from` or `to` do not block. Requires: cut_to_fronts was applied and left both polygons.
  Obstruction(const ConvexPolygon& from, const ConvexPolygon& to, std::span<const ConvexPolygon* const> blockers);

  bool is_clear() const { return parts_.empty(); }
  /// Returns whether a single blocker hides all of `to` from all of `from`.
  bool is_total() const { return is_total_; }
  std::span<const ConvexPolygon> parts() const { return parts_; }

 private:
  std::vector<ConvexPolygon> parts_;
  bool is_total_ = false;
};

/// Returns the exact form factor, in [0, 1], from a differential surface to the visible part of `to`. The shadow of each blocker
/// is cut off, and Lambert's contour formula is summed over the rest. Requires: `blockers` lie between the point's horizon and
/// the plane of `to` (see Obstruction), and `to` above the horizon.
double point_to_visible(Vec3 point, Vec3 normal, const ConvexPolygon& to, std::span<const ConvexPolygon> blockers);

/// A form factor past blockers and its cost.
struct VisibleFormFactor : FormFactor {
  std::uint64_t points = 0;  ///< number of sample points of `from`; 0 if nothing stands between
};

/// Returns the form factor from `from` to the visible part of `to`. If nothing stands between it is that of
/// polygon_form_factor(). Otherwise point_to_visible() is integrated adaptively over `from` until the estimated error is within
/// `accuracy`, relative to the value, or `most_points` were sampled.
VisibleFormFactor visible_form_factor(const ConvexPolygon& from, const ConvexPolygon& to,
                                      std::span<const ConvexPolygon* const> blockers, double accuracy,
                                      std::uint64_t most_points = 400'000);

/// Returns the form factor from `from` to the visible part of `to`, integrated as above, for known blockers. Requires: `from` and
/// `to` lie in front of each other; `blockers` are the parts() of their Obstruction, which is neither clear nor total.
VisibleFormFactor obstructed_form_factor(const ConvexPolygon& from, const ConvexPolygon& to,
                                         std::span<const ConvexPolygon> blockers, double accuracy,
                                         std::uint64_t most_points = 400'000);

}  // namespace alvor
