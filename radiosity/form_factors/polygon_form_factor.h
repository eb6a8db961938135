#pragma once
// Form factors between polygons that nothing stands between.

#include "radiosity/form_factors/convex_polygon.h"

namespace alvor {

/// A form factor and a bound on its error.
struct FormFactor {
  double value = 0;        ///< in [0, 1]
  double error_bound = 0;  ///< absolute
};

/// Returns the form factor from `from` to `to`: 1 / (2 pi A) times the double contour integral of ln r (Sparrow 1963). The inner
/// integral is exact, the outer one adaptive to `accuracy` (absolute). Polygons may touch or cross. Far pairs, whose contours
/// cancel, are integrated over their areas instead. The parts behind the other polygon's plane are cut off first. Requires:
/// planar convex polygons with an area, accuracy > 0.
FormFactor polygon_form_factor(const ConvexPolygon& from, const ConvexPolygon& to, double accuracy);

/// Cuts `from` and `to` to the parts that lie in front of each other; both or one may become empty. A corner closer to a plane
/// than 1e-12 of its polygon's radius and distance lies on it.
void cut_to_fronts(ConvexPolygon& from, ConvexPolygon& to);

}  // namespace alvor
