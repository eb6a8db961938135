#pragma once
// Irradiance in free air, from a finished solution.

#include "meshing/display_mesh.h"
#include "radiosity/rays/medium.h"
#include "radiosity/rays/visibility.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace alvor {

struct GatheredIrradiance {
  Rgb irradiance;             ///< W/m2
  double standard_error = 0;  ///< of irradiance.mean(), W/m2; of the sampling alone, not of the solution
};

/// Gathers what the surfaces of a solution send to a point. Light of emitters: each triangle's exact form factor times the share
/// of it that shadow rays reach, so that it has no error where nothing stands between. All other light: rays distributed by the
/// cosine (Nusselt's analogy). Borrows the mesh and its caster. Immutable; safe from any thread.
class Gatherer {
 public:
  /// `absorption` is of the medium that fills the scene, 1/m per band. Requires: `caster` is of the mesh's triangles.
  Gatherer(const DisplayMesh& mesh, const TriangleCaster& caster, const Rgb& absorption);

  /// The irradiance of a small surface at `point` that looks along `normal` (unit). `stream` names its random numbers. Returns
  /// nothing where most of what can be seen from the point, in all directions, are backs of surfaces, or nothing at all: it lies
  /// inside a solid or outside the room.
  std::optional<GatheredIrradiance> gather(Vec3 point, Vec3 normal, std::uint64_t stream) const;

 private:
  /// The share that arrives of what a triangle would bring if nothing stood between, by band, and the variance of the estimate.
  struct VisibleShare {
    Rgb mean;
    double variance = 0;  ///< of mean.mean()
  };

  bool is_enclosed(Vec3 point, std::uint64_t stream) const;
  GatheredIrradiance from_emitters(Vec3 point, Vec3 normal, std::uint64_t stream) const;
  GatheredIrradiance from_other_surfaces(Vec3 point, Vec3 normal, std::uint64_t stream) const;
  VisibleShare visible_share(Vec3 point, Vec3 normal, std::uint32_t triangle, std::uint32_t rays, std::uint64_t stream) const;
  Vec3 corner(std::uint32_t triangle, int k) const { return mesh_.positions[mesh_.triangles[triangle][k]]; }
  Rgb radiosity(std::uint32_t triangle, double u, double v) const;

  const DisplayMesh& mesh_;
  const TriangleCaster& caster_;
  Medium medium_;
  std::vector<std::uint32_t> emitters_;  ///< triangles
  std::vector<bool> is_emitter_;         ///< by triangle
};

}  // namespace alvor
