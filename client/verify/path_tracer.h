#pragma once
// Computes irradiance by path tracing, against which solutions are verified. It shares with the solver only the scene and the
// library that intersects rays.

#include "client/verify/emitter_tree.h"
#include "client/verify/facets.h"
#include "client/verify/lamps.h"
#include "client/verify/path_random.h"
#include "client/verify/skies.h"
#include "meshing/scene.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

class TriangleCaster;

/// A point of a surface of the scene, on the side that `normal` points to.
struct SurfacePoint {
  Vec3 position;           ///< metres
  Vec3 normal;             ///< unit
  std::uint32_t face = 0;  ///< face of the scene
};

/// Estimates irradiance without bias: the expectation is the solution of the scene's rendering equation (Kajiya 1986), with
/// media. Paths continue in cosine-distributed directions until Russian roulette ends them. At each bend, emitted light is
/// sampled in two ways: by choosing a place on an emitter, and by following the path. They are weighted by the balance heuristic
/// (Veach & Guibas 1995), so no sample exceeds the brightest emission, even in a corner of two emitters. Lamps and distant lights
/// are sampled one at a time, chosen by what they bring unblocked; environments in two ways, as emitters are. At a pane a path
/// bends or goes straight on, by chance; shadow rays go on through panes. Where a texture cuts a surface out, both go on as the
/// opacity of the texel says. At a translucent surface a path bends to the side that it came from or to the other, by chance. One
/// systematic error remains: rays start 1e-6 of the scene's extent above their surface, so that they do not hit it. Immutable;
/// safe from any thread.
class PathTracer {
 public:
  /// Copies what it needs of `scene`. Requires: !find_fault(scene), and at least one face with area.
  explicit PathTracer(const Scene& scene);
  ~PathTracer();
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  /// Returns the mean of `paths` paths from one point: W/m2 per band. Their first directions and first places on emitters are
  /// spread evenly, so the variance must be estimated from several calls with different streams, not from single paths. Best if
  /// `paths` is a power of two.
  Rgb irradiance(const SurfacePoint& point, std::uint32_t paths, PathRandom random) const;

  /// Returns whether the point lies under or inside a solid: most of `rays` cosine-distributed rays meet black backs, and nine
  /// tenths of as many paths end at one that begin along the surface and bend at the fronts that they meet. The paths tell a
  /// narrow gap between a surface and a back, by which they leave, from a place inside a solid, into which fronts of other solids
  /// may reach: the floor under a seat whose ends are its two arms.
  bool is_enclosed(const SurfacePoint& point, std::uint32_t rays, PathRandom random) const;

 private:
  /// A triangle that rays can hit, in local coordinates: centred, longest side 1.
  struct Surface {
    Vec3 corner, side_u, side_v, normal;
    Rgb emission, reflectance;
    bool two_sided = false;
    std::uint32_t light = 0;  ///< index in lights_ and surface_of_light_ if the surface emits
    Rgb through;              ///< regular transmittance of what is there
    std::optional<Texture> texture;
    std::array<TexturePoint, 3> texture_points;  ///< of the corners, if there is a texture
    std::array<RgbF, 3> colours;                 ///< of the corners
    Rgb scattered;                               ///< diffuse transmittance
    bool has_cutout() const { return texture && texture->image->has_opacity; }
    bool is_pane() const { return !through.is_zero() || has_cutout(); }
    TexturePoint texture_point_at(double u, double v) const;
    /// Returns the reflectance of what is there at a place.
    Rgb reflectance_at(double u, double v) const;
    /// Returns the share of the surface that is there at a place, in [0, 1].
    double opacity_at(double u, double v) const { return has_cutout() ? texture->opacity_at(texture_point_at(u, v)) : 1; }
    /// Returns the share of light that goes straight on at a place.
    Rgb through_at(double u, double v) const;
  };
  /// A point at which a path bends, just above a surface.
  struct Bend {
    Vec3 place, normal;
  };
  /// The random numbers used at one bend.
  struct Choices {
    UnitPair light, direction;
  };
  /// The surface that a ray hits, and the next bend there.
  struct Met {
    const Surface* surface = nullptr;  ///< null if the path leaves the scene or meets a black back
    Bend bend;
    double distance = 0, cosine = 0;  ///< cosine on the side that was hit, > 0
    double u = 0, v = 0;              ///< on the surface
    bool is_outside = false;          ///< the path leaves the scene
    bool is_black_back() const { return !surface && !is_outside; }
    /// The number of the surface that the ray hits, from either side, if light goes straight on there.
    std::optional<std::uint32_t> pane;
    Rgb through;         ///< share of light that goes straight on
    double opacity = 1;  ///< share of the surface that is there
    double chance_to_go_on() const;
  };

  Bend start_at(const SurfacePoint& point) const;
  void add_surfaces(const Scene& scene, std::span<const Facet> facets);
  Rgb path(Bend bend, Choices choices, PathRandom& random) const;
  Rgb from_chosen_light(const Bend& bend, UnitPair choice) const;
  Rgb from_skies(const Bend& bend, Vec3 direction) const;
  Rgb from_surroundings(const Bend& bend, UnitPair choice) const;
  Rgb from_lamps(const Bend& bend, PathRandom& random) const;
  Rgb from_met_light(const Bend& bend, Vec3 direction, const Met& met) const;
  Met meet(const Bend& bend, Vec3 direction, std::span<const std::uint32_t> passed = {}) const;
  Met behind_panes(const Bend& bend, Vec3 direction) const;
  Met follow(const Bend& bend, Vec3 direction, PathRandom& random, Rgb& throughput) const;
  static Bend bend_at(const Met& met, PathRandom& random, Rgb& throughput);
  Rgb passing(Vec3 from, Vec3 to) const;
  Rgb transmittance(double distance) const;

  Extent extent_;
  Rgb absorption_;  ///< absorption coefficient per local unit of length
  bool clear_ = true, has_panes_ = false;
  std::vector<Surface> surfaces_;
  EmitterTree lights_{{}};
  std::vector<std::uint32_t> surface_of_light_;
  Lamps lamps_;
  Skies skies_;
  std::unique_ptr<const TriangleCaster> caster_;
};

}  // namespace alvor
