#pragma once
// The base mesh in the rays' coordinates: float32, centred, longest side 1.

#include "meshing/base_mesh.h"
#include "meshing/patch_place.h"
#include "radiosity/rays/visibility.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alvor {

struct Float3 {
  float x, y, z;
};

/// One root patch in local units. A quad's point at (u, v) is origin + u edge_u + v edge_v + u v twist.
struct LocalRoot {
  Float3 origin, edge_u, edge_v, twist;
  Float3 tangent, bitangent, normal;  ///< orthonormal, right-handed
  float twist_u = 0, twist_v = 0;     ///< twist = twist_u edge_u + twist_v edge_v; both 0 for parallelograms and triangles
  bool is_quad = false;
  std::uint32_t twin = RootPatch::no_twin;
};

/// A mesh made ready for rays: its root patches in local coordinates, and Embree's scene of them. Immutable. Borrows the mesh.
class LocalScene {
 public:
  explicit LocalScene(const BaseMesh& mesh);

  const BaseMesh& mesh() const { return *mesh_; }
  const LocalFrame& frame() const { return frame_; }
  const Visibility& visibility() const { return visibility_; }
  const LocalRoot& root(std::uint32_t r) const { return roots_[r]; }
  /// Returns the corners of root `r`, 3 or 4, in local units and double precision.
  std::span<const Vec3> corners(std::uint32_t r) const {
    return std::span(corners_[r]).first(static_cast<std::size_t>(mesh_->roots()[r].corner_count));
  }

  /// Writes to `path` the path (see PatchId::finest) of the finest patch that each of the sixteen rays hit. The path of a ray
  /// that hit nothing is arbitrary. Requires: `path` has sixteen places.
  void places_of_hits(const HitPacket& hits, std::uint32_t* path) const;

 private:
  const BaseMesh* mesh_;
  LocalFrame frame_;
  Visibility visibility_;
  std::vector<LocalRoot> roots_;
  bool has_twisted_quads_ = false, has_triangles_ = false;
  std::vector<std::array<Vec3, 4>> corners_;
};

}  // namespace alvor
