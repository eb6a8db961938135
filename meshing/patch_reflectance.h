#pragma once
// The reflectance of patches on faces with textures or colours.

#include "meshing/base_mesh.h"
#include "meshing/patch_place.h"
#include "meshing/texture_mean.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>

namespace alvor {

/// A place in the plane of a root patch: corner 0 + a (corner 1 - corner 0) + b (corner 2 - corner 0).
struct PlanePoint {
  double a = 0, b = 0;
};

/// Returns the texture point at (u, v) of a root patch. On a quad it is linear on each side of the diagonal from corner 0 to
/// corner 2. Requires: the root's material has a texture.
TexturePoint texture_point_at(const BaseMesh& mesh, std::uint32_t root, Uv at);

/// Returns the share of a root patch that is there at (u, v) and no hole, in [0, 1].
double opacity_at(const BaseMesh& mesh, std::uint32_t root, Uv at);

/// Returns the colour at (u, v) of a root patch, by which its reflectance is multiplied; linear as texture points are.
Rgb colour_at(const BaseMesh& mesh, std::uint32_t root, Uv at);

/// Mean reflectances and covers of patches. A patch on a texture has the mean of the texels that it covers, so that a patch has
/// the area-weighted mean of what is there of its children; so does one with colours. Of a patch with both, each counts by its
/// mean on each side of the diagonal. Immutable; safe from any thread. Borrows the mesh.
class PatchReflectance {
 public:
  explicit PatchReflectance(const BaseMesh& mesh);
  /// Returns how much memory it takes for a mesh, bytes.
  static std::size_t bytes_for(const BaseMesh& mesh);

  MeanSurface of(const PatchShape& shape) const;
  /// Returns whether the reflectance or the cover of a root changes over it.
  bool varies(std::uint32_t root) const;

 private:
  class TextureMap;
  MeanSurface of_part(std::uint32_t root, const TextureMap& map, std::span<const PlanePoint> part) const;

  const BaseMesh& mesh_;
  std::unordered_map<const ColourImage*, TextureMean> means_;  // of the images that faces use
};

}  // namespace alvor
