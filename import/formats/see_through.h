#pragma once
// How importers make panes of materials that are transparent or have holes.

#include "meshing/scene.h"

namespace alvor {

/// Lets a share of the light that meets a surface go straight through it, tinted by its colour: clear glass. Requires: `share` is
/// in [0, 1].
inline void let_through(Material& material, double share) {
  material.regular_transmittance = share * material.reflectance;
  material.reflectance *= 1 - share;
}

/// Leaves a share of a surface there; the rest of it is holes. Requires: `share` is in [0, 1].
inline void leave(Material& material, double share) {
  material.emission *= share;
  material.reflectance *= share;
  material.regular_transmittance = share * material.regular_transmittance + Rgb{1 - share, 1 - share, 1 - share};
}

}  // namespace alvor
