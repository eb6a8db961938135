#pragma once
// The interface of a light, through which the direct field computes its irradiance and its shadows.

#include "radiosity/form_factors/convex_polygon.h"
#include "radiosity/rays/ray_source.h"
#include "radiosity/rays/visibility.h"
#include "solution/relative_light.h"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// One packet of shadow rays that is to be set: ray o starts at point o of `from`, on a surface with the unit normal `normal`,
/// and ends at the place of the light that `at[o]`, uniform in the unit square, stands for.
struct ShadowAim {
  const PatchPoints& from;
  Float3 normal;
  std::array<Uv, RayPacket::width> at;
  RayPacket& rays;
  std::array<float, RayPacket::width>& weights;  ///< light that arrives by each ray if nothing blocks it, see sample_scale()
  /// Share of its light that each ray brings if nothing blocks it, less than 1 where the light has holes or counts elsewhere: 1,
  /// until a light sets it. Null if ShadowNeeds::partial is off.
  std::array<float, RayPacket::width>* there = nullptr;

  Vec3 start(std::size_t o) const { return {from.x[o], from.y[o], from.z[o]}; }
  Vec3 facing() const { return {normal.x, normal.y, normal.z}; }
  /// Sets ray `o` along `way` (local units), of which it may be blocked up to the share `end`, and its weight.
  void set(std::size_t o, Vec3 way, float end, double weight) const {
    rays.set(o, start(o), way, end);
    weights[o] = static_cast<float>(weight);
  }
};

/// Share of the way to a light at which a shadow ray ends, so that the light and what it is fixed to do not block it. Chosen;
/// half and double give the same solutions (docs/design/constants.md).
constexpr float short_of_light = 1 - 1e-4f;
/// Smallest distance from which a light is looked at, local units: closer, that of a point would grow without bound.
constexpr double nearest_look = 1e-5;

/// Bounds on what a light brings, for the LightTree. Local units (see LocalFrame).
struct LightExtent {
  Vec3 place;      ///< a point of the light
  Vec3 low, high;  ///< corners of its bounding box
  Vec3 normal;     ///< unit, if the light shines only to the front of a plane that holds it; else zero
  /// A surface that faces the light at distance d receives at most power / (pi d2), and never more than `brightest`. Both are
  /// sums over bands, in emission units.
  double power = 0, brightest = 0;
};

/// A light: an emitting face, a lamp, the sun. Its unblocked irradiance at a point is colour() times a number that only geometry
/// decides. Immutable; safe from any thread. The scene that it was made from must outlive it.
class LightSource {
 public:
  /// `number` tells the lights of a scene apart: it selects the random numbers of shadow rays. `power` is what the light sends
  /// out, in emission units times m2, summed over bands.
  LightSource(std::uint32_t number, const RelativeLight& colour, double power)
      : number_(number), colour_(colour), power_(power) {}
  virtual ~LightSource() = default;
  LightSource(const LightSource&) = delete;
  LightSource& operator=(const LightSource&) = delete;

  std::uint32_t number() const { return number_; }
  const RelativeLight& colour() const { return colour_; }
  double power() const { return power_; }

  /// Returns whether the light can reach the front of a root patch at all, as far as one can tell at no cost.
  virtual bool may_reach(std::uint32_t) const { return true; }
  /// Returns the irradiance at a point of a surface with this unit normal, if nothing blocks it and the light has no holes, in
  /// multiples of colour(). Local units.
  virtual double unblocked(Vec3 at, Vec3 normal) const = 0;
  /// Sets rays and weights of the lanes [first, last). The mean weight over the unit square, times sample_scale(1), is
  /// unblocked(). A weight is 0 where the light is below the horizon of the surface.
  virtual void aim(const ShadowAim& aim, std::size_t first, std::size_t last) const = 0;
  /// Returns the factor from a weight to irradiance, in multiples of colour(), if the light was chosen with `probability`.
  virtual double sample_scale(double probability) const = 0;
  /// Returns the corners of a light that is a convex planar polygon of even emission without holes, counter-clockwise as seen
  /// from its front; none for other lights. Its irradiance is then the form factor to what is visible of it. Local units.
  virtual std::span<const Vec3> polygon() const { return {}; }
  /// Returns the corners of a rectangle through which a light from infinitely far away shines evenly enough for through(); none
  /// for other lights. Faces on both sides of it may hide the light. Local units.
  virtual std::span<const Vec3> aperture() const { return {}; }
  /// Returns the irradiance, as unblocked() does, that comes through `parts` of aperture(), of which nothing is hidden from the
  /// point. May change `parts`. Requires: aperture(); the parts lie above the surface's horizon.
  virtual double through(std::vector<ConvexPolygon>&, Vec3, Vec3) const { return 0; }
  /// Returns whether a ray that nothing blocks may bring less than its weight for a reason other than a face on its way.
  virtual bool has_partial_rays() const { return false; }
  /// Returns nothing if the light comes from outside of the scene.
  virtual std::optional<LightExtent> extent() const = 0;

 private:
  std::uint32_t number_;
  RelativeLight colour_;
  double power_;
};

/// Lights that are owned by somebody else.
using LightSources = std::span<const LightSource* const>;

}  // namespace alvor
