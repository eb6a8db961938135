#pragma once
// Casts rays into a solution's mesh and interpolates its values.

#include "client/picture/camera.h"
#include "meshing/mesh_radiosity.h"
#include "meshing/mesh_transmittance.h"
#include "radiosity/rays/triangle_caster.h"

#include <functional>
#include <optional>

namespace alvor {

/// A visible point on the front of a triangle.
struct Seen {
  std::uint32_t triangle = 0;
  double u = 0, v = 0;
  RgbF tint{1, 1, 1};  ///< share of its light that goes through the panes before it
  RgbF before;         ///< radiosity of these panes, as far as it reaches the eye
};

/// Casts rays into a mesh, which must outlive it. Immutable; safe from any thread. Requires: !mesh.triangles.empty().
class Stage {
 public:
  explicit Stage(const DisplayMesh& mesh);
  const DisplayMesh& mesh() const { return mesh_; }
  const TriangleCaster& caster() const { return caster_; }

  /// Returns the first front side along a ray at a place that lets no light through. If there is none, returns the last pane if
  /// any of them shines. Back sides are transparent, so that a closed room can be seen from outside; those of one-sided panes dim
  /// what lies behind them, as in the solve: a window made as a box is two panes.
  std::optional<Seen> look(Vec3 origin, Vec3 direction) const;
  /// Calls `on_seen` for the points of a coarse picture, the same for any size of the camera's picture: enough for exposure and
  /// scales.
  void glance(const Camera& camera, const std::function<void(const Seen&)>& on_seen) const;

  Vec3 place(const Seen& seen) const;  ///< position of the point, metres
  Vec3 normal(const Seen& seen) const { return normalized(area_vector(seen.triangle)); }
  /// Returns the radiosity that reaches the eye.
  RgbF radiosity(const Seen& seen) const {
    return seen.before + seen.tint * narrow(radiosity_.at(seen.triangle, seen.u, seen.v));
  }
  RgbF irradiance(const Seen& seen) const { return interpolated(mesh_.irradiance, seen); }

  /// Returns the told error of the irradiance, W/m2. Requires: !mesh().errors.empty().
  double error(const Seen& seen) const { return error_at(mesh_, seen.triangle, seen.u, seen.v); }

  /// Returns the weight of the triangle's first vertex where the ray meets its plane: 0 on the leaf's outline, 1 at its centre.
  double centre_weight(std::uint32_t triangle, Vec3 origin, Vec3 direction) const;

 private:
  std::optional<Seen> look_through_panes(Vec3 origin, Vec3 direction) const;
  Vec3 corner(std::uint32_t triangle, int k) const { return mesh_.positions[mesh_.triangles[triangle][k]]; }
  Vec3 area_vector(std::uint32_t triangle) const;
  RgbF interpolated(const std::vector<RgbF>& values, const Seen& seen) const;

  const DisplayMesh& mesh_;
  TriangleCaster caster_;
  MeshRadiosity radiosity_;
  MeshTransmittance transmittance_;
};

}  // namespace alvor
