#pragma once

#include "meshing/display_mesh.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// The radiosity of a display mesh by place: interpolated between vertices, and under textures by their texels. Immutable; safe
/// from any thread. Borrows the mesh.
class MeshRadiosity {
 public:
  explicit MeshRadiosity(const DisplayMesh& mesh);

  /// Returns the radiosity at the point (1-u-v) a + u b + v c of a triangle, W/m2.
  Rgb at(std::uint32_t triangle, double u, double v) const;

 private:
  const DisplayMesh& mesh_;
  std::vector<const Material*> textured_;  // by triangle, see textured_of()
};

}  // namespace alvor
