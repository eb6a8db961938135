#pragma once
// A solution made ready to be looked at.

#include "client/picture/camera.h"
#include "radiosity/rays/visibility.h"

#include <functional>
#include <optional>

namespace alvor {

/// A point of the front of a surface.
struct Seen {
  std::uint32_t triangle = 0;
  double u = 0, v = 0;
};

/// Rays into a mesh, which must outlive it. Immutable; any number of threads may look at a time. Requires:
/// !mesh.triangles.empty().
class Stage {
 public:
  explicit Stage(const DisplayMesh& mesh);
  const DisplayMesh& mesh() const { return mesh_; }
  const TriangleCaster& caster() const { return caster_; }

  /// The first front along a ray. Backs are looked through, so that a closed room can be seen from outside.
  std::optional<Seen> look(Vec3 origin, Vec3 direction) const;
  /// What a coarse picture sees, the same whatever the size of the camera's picture: enough for exposure and scales.
  void glance(const Camera& camera, const std::function<void(const Seen&)>& on_seen) const;

  Vec3 place(const Seen& seen) const;  ///< metres
  Vec3 normal(const Seen& seen) const { return normalized(area_vector(seen.triangle)); }
  RgbF radiosity(const Seen& seen) const { return interpolated(mesh_.radiosity, seen); }
  RgbF irradiance(const Seen& seen) const { return interpolated(mesh_.irradiance, seen); }

  /// Weight of the first vertex where the ray meets the plane of `triangle`: 0 on the leaf's outline, 1 at its centre.
  double centre_weight(std::uint32_t triangle, Vec3 origin, Vec3 direction) const;

 private:
  Vec3 corner(std::uint32_t triangle, int k) const { return mesh_.positions[mesh_.triangles[triangle][k]]; }
  Vec3 area_vector(std::uint32_t triangle) const;
  RgbF interpolated(const std::vector<RgbF>& values, const Seen& seen) const;

  const DisplayMesh& mesh_;
  TriangleCaster caster_;
};

}  // namespace alvor
