#pragma once
// Form factors between polygons that others stand between.

#include "radiosity/form_factors/polygon_form_factor.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// What may stand between two polygons, and what of it does.
class Obstruction {
 public:
  /// Keeps of each of `blockers` what reaches into the convex hull of `from` and `to`. Blockers block from both sides; those in
  /// the plane of `from` or `to` do not. Requires: cut_to_fronts was applied and left something.
  Obstruction(const ConvexPolygon& from, const ConvexPolygon& to, std::span<const ConvexPolygon* const> blockers);

  bool is_clear() const { return parts_.empty(); }
  /// A single blocker hides all of `to` from all of `from`.
  bool is_total() const { return is_total_; }
  std::span<const ConvexPolygon> parts() const { return parts_; }

 private:
  std::vector<ConvexPolygon> parts_;
  bool is_total_ = false;
};

/// Exact form factor from a differential surface to what is visible of `to`: the shadow of each blocker is cut off, and Lambert's
/// contour formula sums over what remains. In [0, 1]. Requires: `blockers` lie between the point's horizon and the plane of `to`
/// (see Obstruction), and `to` above the horizon.
double point_to_visible(Vec3 point, Vec3 normal, const ConvexPolygon& to, std::span<const ConvexPolygon> blockers);

struct VisibleFormFactor : FormFactor {
  std::uint64_t points = 0;  ///< of `from` that were looked from; 0 when nothing stands between
};

/// From `from` to what is visible of `to`: exact where nothing stands between, else point_to_visible integrated adaptively over
/// `from` until the error estimate is within `accuracy`, relative to the value, or `most_points` were looked from.
VisibleFormFactor visible_form_factor(const ConvexPolygon& from, const ConvexPolygon& to,
                                      std::span<const ConvexPolygon* const> blockers, double accuracy,
                                      std::uint64_t most_points = 400'000);

/// The same for a pair of which an Obstruction is known that is neither clear nor total. Requires: `from` and `to` in front of
/// each other.
VisibleFormFactor obstructed_form_factor(const ConvexPolygon& from, const ConvexPolygon& to,
                                         std::span<const ConvexPolygon> blockers, double accuracy,
                                         std::uint64_t most_points = 400'000);

}  // namespace alvor
