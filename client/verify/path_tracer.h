#pragma once
// Irradiance by path tracing: what solutions are verified against. It has nothing in common with the solver but the scene and
// the library that finds what a ray hits.

#include "client/verify/facets.h"
#include "client/verify/light_tree.h"
#include "client/verify/path_random.h"
#include "meshing/scene.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace alvor {

class TriangleCaster;

/// A point of a surface of the scene, seen from the side that `normal` looks to.
struct SurfacePoint {
  Vec3 position;           ///< metres
  Vec3 normal;             ///< unit
  std::uint32_t face = 0;  ///< of the scene
};

/// Estimates irradiance without bias: its expectation is the solution of the rendering equation (Kajiya 1986) of the scene,
/// media and all. Paths go on in cosine-distributed directions until Russian roulette ends them; at each of their points,
/// emitted light is sampled both ways, by choosing a place of an emitter and by looking where the path goes, and each way counts
/// by the balance heuristic (Veach & Guibas 1995), so that no sample exceeds the brightest emission, even in a corner
/// of two emitters. The one systematic error are rays that start 1e-6 of the scene's extent off their surface, lest they meet
/// it. Immutable; any number of threads may trace at a time.
class PathTracer {
 public:
  /// Requires: !find_fault(scene), and at least one face with area. Keeps nothing of `scene`.
  explicit PathTracer(const Scene& scene);
  ~PathTracer();
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  /// The mean of `paths` paths from one point: W/m2 per band. Their first directions and first places on emitters are spread
  /// evenly, so that means of several calls, each with its own stream, tell the variance, and single paths do not. Best if
  /// `paths` is a power of two.
  Rgb irradiance(const SurfacePoint& point, std::uint32_t paths, PathRandom random) const;

  /// Whether most of what is seen from a point are black backs, by twice this many rays, also along the surface: then it lies under or
  /// inside a solid, among whose insides may be fronts of others that reach into it. In a gap between a surface and a back, however
  /// narrow, rays along the surface get out: that is not enclosed.
  bool is_enclosed(const SurfacePoint& point, std::uint32_t rays, PathRandom random) const;

 private:
  /// What a ray can hit; local coordinates: centred, longest side 1.
  struct Surface {
    Vec3 corner, side_u, side_v, normal;
    Rgb emission, reflectance;
    bool two_sided = false;
    std::uint32_t light = 0;  ///< of lights_, where it emits
  };
  /// Where paths bend: just above a surface.
  struct Bend {
    Vec3 place, normal;
  };
  /// The random numbers of one bend.
  struct Choices {
    UnitPair light, direction;
  };
  struct Met {
    const Surface* surface = nullptr;  ///< null where the path leaves the scene or ends on a black back
    Bend bend;
    double distance = 0, cosine = 0;  ///< cosine on the side that was met, > 0
  };

  Bend start_at(const SurfacePoint& point) const;
  void add_surfaces(const Scene& scene, std::span<const Facet> facets);
  Rgb path(Bend bend, Choices choices, PathRandom& random) const;
  Rgb from_chosen_light(const Bend& bend, UnitPair choice) const;
  Rgb from_met_light(const Bend& bend, Vec3 direction, const Met& met) const;
  Met meet(const Bend& bend, Vec3 direction) const;
  Rgb transmittance(double distance) const;

  Extent extent_;
  Rgb absorption_;  ///< per local unit of length
  bool clear_ = true;
  std::vector<Surface> surfaces_;
  LightTree lights_{{}};
  std::unique_ptr<const TriangleCaster> caster_;
};

}  // namespace alvor
