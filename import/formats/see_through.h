#pragma once
// How importers make panes of materials that are transparent or have holes, and translucent ones.

#include "meshing/scene.h"

namespace alvor {

/// Multiplies by `share` what a material reflects and scatters.
inline void scale_albedo(Material& material, double share) {
  material.reflectance *= share;
  material.diffuse_transmittance *= share;
  if (material.texture) material.texture->factor *= share;
}

/// Lets a share of the light that meets a surface go straight through it, tinted by its mean colour: clear glass. What a texture
/// cuts out stays cut out. Requires: `share` is in [0, 1].
inline void let_through(Material& material, double share) {
  material.regular_transmittance = share * material.reflectance;
  scale_albedo(material, 1 - share);
}

/// Scatters a share of the light that meets a surface, per band, into all directions behind it, from either side.
inline void make_translucent(Material& material, const Rgb& transmittance) {
  material.diffuse_transmittance = transmittance;
  if (material.is_translucent()) material.two_sided = true;
}

/// Leaves a share of a surface there; the rest of it is holes. Requires: `share` is in [0, 1].
inline void leave(Material& material, double share) {
  material.emission *= share;
  scale_albedo(material, share);
  material.regular_transmittance = share * material.regular_transmittance + Rgb{1 - share, 1 - share, 1 - share};
}

}  // namespace alvor
