#pragma once
// Irradiance in free air, from a finished solution.

#include "meshing/display_mesh.h"
#include "radiosity/visibility.h"

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
  /// Requires: `caster` is of the mesh's triangles.
  Gatherer(const DisplayMesh& mesh, const TriangleCaster& caster);

  /// The irradiance of a small surface at `point` that looks along `normal` (unit). `stream` names its random numbers. Returns
  /// nothing where most of what can be seen from the point, in all directions, are backs of surfaces, or nothing at all: it lies
  /// inside a solid or outside the room.
  std::optional<GatheredIrradiance> gather(Vec3 point, Vec3 normal, std::uint64_t stream) const;

 private:
  /// Of what a triangle brings where nothing stands between: the share that arrives, and the variance of this estimate.
  struct VisibleShare {
    double mean = 0, variance = 0;
  };

  bool is_enclosed(Vec3 point, std::uint64_t stream) const;
  GatheredIrradiance from_emitters(Vec3 point, Vec3 normal, std::uint64_t stream) const;
  GatheredIrradiance from_other_surfaces(Vec3 point, Vec3 normal, std::uint64_t stream) const;
  VisibleShare visible_share(Vec3 point, Vec3 normal, std::uint32_t triangle, std::uint32_t rays, std::uint64_t stream) const;
  Vec3 corner(std::uint32_t triangle, int k) const { return mesh_.positions[mesh_.triangles[triangle][k]]; }
  Rgb radiosity(std::uint32_t triangle, double u, double v) const;

  const DisplayMesh& mesh_;
  const TriangleCaster& caster_;
  std::vector<std::uint32_t> emitters_;  ///< triangles
  std::vector<bool> is_emitter_;         ///< by triangle
};

}  // namespace alvor
