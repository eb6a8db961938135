#pragma once
// The reflectance of patches on faces with textures.

#include "meshing/base_mesh.h"
#include "meshing/patch_place.h"
#include "meshing/texture_mean.h"

#include <unordered_map>

namespace alvor {

/// Returns the texture point at (u, v) of a root patch. On a quad it is linear on each side of the diagonal from corner 0 to
/// corner 2. Requires: the root's material has a texture.
TexturePoint texture_point_at(const BaseMesh& mesh, std::uint32_t root, Uv at);

/// Mean reflectances of patches. A patch on a texture has the mean of the texels that it covers, so that a patch has the
/// area-weighted mean of its children. Immutable; safe from any thread. Borrows the mesh.
class PatchReflectance {
 public:
  explicit PatchReflectance(const BaseMesh& mesh);

  Rgb of(const PatchShape& shape) const;
  bool has_texture(std::uint32_t root) const { return mesh_.material_of(root).texture.has_value(); }

 private:
  const BaseMesh& mesh_;
  std::unordered_map<const ColourImage*, TextureMean> means_;  // of the images that faces use
};

}  // namespace alvor
