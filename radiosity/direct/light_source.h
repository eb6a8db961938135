#pragma once
// The interface of a light, through which the direct field computes its irradiance and its shadows.

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
};

/// Sets ray `o` of the packet: from its origin along `way` (local units), of which it may be blocked up to the share `end`.
inline void set_ray(const ShadowAim& aim, int o, Vec3 way, float end) {
  RayPacket& rays = aim.rays;
  rays.origin_x[o] = aim.from.x[o], rays.origin_y[o] = aim.from.y[o], rays.origin_z[o] = aim.from.z[o];
  rays.direction_x[o] = static_cast<float>(way.x);
  rays.direction_y[o] = static_cast<float>(way.y);
  rays.direction_z[o] = static_cast<float>(way.z);
  rays.t_min[o] = 0;
  rays.t_max[o] = end;
}

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
  /// Returns the irradiance at a point of a surface with this unit normal, if nothing blocks it, in multiples of colour(). Local
  /// units.
  virtual double unblocked(Vec3 at, Vec3 normal) const = 0;
  /// Sets rays and weights of the lanes [first, last). The mean weight over the unit square, times sample_scale(1), is
  /// unblocked(). A weight is 0 where the light is below the horizon of the surface.
  virtual void aim(const ShadowAim& aim, int first, int last) const = 0;
  /// Returns the factor from a weight to irradiance, in multiples of colour(), if the light was chosen with `probability`.
  virtual double sample_scale(double probability) const = 0;
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
