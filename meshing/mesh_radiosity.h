#pragma once

#include "meshing/display_mesh.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// Returns the place on the texture at the point (1-u-v) a + u b + v c of a triangle. Requires: the mesh has texture points.
TexturePoint texture_point_at(const DisplayMesh& mesh, std::uint32_t triangle, double u, double v);

/// The radiosity of a display mesh by place: interpolated between vertices, and under textures by their texels. Immutable; safe
/// from any thread. Borrows the mesh.
class MeshRadiosity {
 public:
  explicit MeshRadiosity(const DisplayMesh& mesh);

  /// Returns the radiosity at the point (1-u-v) a + u b + v c of a triangle, W/m2. Where a share of the surface is cut out, the
  /// rest of it shines: a hole has none.
  Rgb at(std::uint32_t triangle, double u, double v) const;
  /// Returns the radiosity that the point would have if nothing were cut out there.
  Rgb of_what_is_there(std::uint32_t triangle, double u, double v) const;

 private:
  /// Returns the material if it has a texture, else null.
  const Material* textured(std::uint32_t triangle) const { return textured_.empty() ? nullptr : textured_[triangle]; }

  const DisplayMesh& mesh_;
  std::vector<const Material*> textured_;  // by triangle, see textured_of()
};

}  // namespace alvor
