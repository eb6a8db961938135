#pragma once
// Form factors between polygons that nothing stands between.

#include "radiosity/form_factors/convex_polygon.h"

namespace alvor {

/// A form factor and how far it may be from the truth.
struct FormFactor {
  double value = 0;        ///< in [0, 1]
  double error_bound = 0;  ///< absolute
};

/// From `from` to `to`: F = 1 / (2 pi A) of the double contour integral of ln r (Sparrow 1963). The inner integral is exact, the
/// outer one adaptive to `accuracy` (absolute); touching and crossing polygons are no special case. Far pairs, whose contours
/// cancel, are integrated over their areas instead. What lies behind the other's plane is cut off first. Requires: planar convex
/// polygons with an area, accuracy > 0.
FormFactor polygon_form_factor(const ConvexPolygon& from, const ConvexPolygon& to, double accuracy);

/// The parts of two polygons that lie in front of each other; empty ones if there are none. `from` and `to` are cut in place.
/// Corners within `slack` of a plane count as on it.
void cut_to_fronts(ConvexPolygon& from, ConvexPolygon& to);

}  // namespace alvor
