#pragma once
// The flat faces that a luminous opening is made of.

#include "meshing/light.h"
#include "meshing/patch_place.h"

#include <vector>

namespace alvor {

/// A rectangle, or the ellipse in it. Metres.
struct OpeningFace {
  Vec3 centre, half_u, half_v;  ///< half_u and half_v are perpendicular to each other and to the normal
  Vec3 normal;                  ///< unit, outwards
  bool is_round = false;
  double area = 0;

  /// Returns a point of the face; uniform by area for `at` uniform in the unit square.
  Vec3 at(Uv at) const;
};

/// Returns the faces from which a luminaire shines: one for a rectangle or an ellipse, six for a box, and for a cylinder its two
/// ends and eight sides that have its area. None for a point or a sphere. Requires: a luminaire; !fault_in(luminaire).
std::vector<OpeningFace> faces_of_opening(const Light& luminaire);

}  // namespace alvor
