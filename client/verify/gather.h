#pragma once
// Computes irradiance in free air from a finished solution.

#include "client/verify/lamps.h"
#include "client/verify/skies.h"
#include "meshing/mesh_radiosity.h"
#include "meshing/mesh_transmittance.h"
#include "radiosity/rays/medium.h"
#include "radiosity/rays/triangle_caster.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace alvor {

struct GatheredIrradiance {
  Rgb irradiance;             ///< W/m2
  Rgb from_surfaces;          ///< the part that comes from surfaces that do not emit, W/m2
  double standard_error = 0;  ///< error of irradiance.mean(), W/m2; only from sampling, not from the solution
  double told_error = 0;  ///< error of irradiance.mean() by what the solution tells of its own, as if all of it erred alike, W/m2
};

/// Gathers the light that the surfaces of a solution send to a point. Light from emitters is each triangle's exact form factor
/// times its visible fraction by shadow rays, so it is exact if nothing blocks; light of lamps is exact, but for soft shadows.
/// All other light is sampled by cosine-distributed rays (Nusselt's analogy). Borrows the mesh and its caster. Immutable; safe
/// from any thread.
class Gatherer {
 public:
  /// `absorption` is the absorption coefficient of the medium that fills the scene, 1/m per band. Requires: `caster` holds the
  /// mesh's triangles.
  Gatherer(const DisplayMesh& mesh, const TriangleCaster& caster, const Rgb& absorption);

  /// Returns the irradiance of a small surface at `point` that faces along `normal` (unit). `stream` selects the random numbers.
  /// Returns nothing if most surfaces around the point show it their backs: the point lies inside a solid
  /// or outside the room.
  /// `effort` is the share of the usual number of rays that is sent, in (0, 1].
  std::optional<GatheredIrradiance> gather(Vec3 point, Vec3 normal, std::uint64_t stream, double effort = 1) const;

  /// Returns whether a triangle emits light.
  bool is_emitter(std::uint32_t triangle) const { return is_emitter_[triangle]; }

  /// Returns the share of light that goes straight from one place to another past the surfaces, per band.
  Rgb passing(Vec3 from, Vec3 to) const;

 private:
  /// The fraction of a triangle's unblocked light that arrives, by band, and the variance of that estimate.
  struct VisibleShare {
    Rgb mean;
    double variance = 0;  ///< variance of mean.mean()
  };

  /// The share of light that goes straight on where a triangle is hit, from the side that it is met on. The back of a two-sided
  /// pane is passed: its front, drawn close to it, dims.
  Rgb through(const TriangleCaster::Hit& hit, Vec3 direction) const;
  bool meets_front(std::uint32_t triangle, Vec3 direction) const;
  /// Light from a direction, and the told error of the part that comes from surfaces.
  struct Arriving {
    Rgb light;
    double error = 0;
  };
  Arriving from_direction(Vec3 point, Vec3 direction) const;
  double relative_error(const TriangleCaster::Hit& hit) const;
  bool is_enclosed(Vec3 point, std::uint64_t stream) const;
  GatheredIrradiance from_emitters(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const;
  GatheredIrradiance from_lamps(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const;
  GatheredIrradiance from_other_surfaces(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const;
  VisibleShare visible_share(Vec3 point, Vec3 normal, std::uint32_t triangle, std::uint32_t rays, std::uint64_t stream) const;
  Vec3 corner(std::uint32_t triangle, int k) const { return mesh_.positions[mesh_.triangles[triangle][k]]; }

  const DisplayMesh& mesh_;
  const TriangleCaster& caster_;
  MeshRadiosity radiosity_;
  Medium medium_;
  Lamps lamps_;  ///< metres
  Skies skies_;
  std::vector<std::uint32_t> emitters_;  ///< indices of the triangles that emit
  std::vector<bool> is_emitter_;         ///< by triangle
  MeshTransmittance transmittance_;
};

}  // namespace alvor
