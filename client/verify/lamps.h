#pragma once
// The lamps and distant lights of a scene, except skies and environments, for the path tracer. Written apart from the solver's
// (radiosity/direct), so that an error in one is seen.

#include "client/verify/facets.h"
#include "client/verify/path_random.h"
#include "meshing/opening_face.h"
#include "meshing/scene.h"

#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// Samples the irradiance from lamps and distant lights in local coordinates (centred, longest side 1). A lamp with a radius is a
/// sphere that looks equally bright from everywhere; one of its points is sampled in the cone in which it is seen. Immutable.
class Lamps {
 public:
  Lamps() = default;
  /// `extent` tells the local coordinates; `surface_points` (metres) are those of the scene, beyond which nothing blocks.
  Lamps(std::span<const Light> lights, const Extent& extent, std::span<const Vec3> surface_points);

  bool empty() const { return lamps_.empty(); }
  std::size_t size() const { return lamps_.size(); }
  /// Returns whether the lamp has a size, so that its samples differ.
  bool is_soft(std::size_t lamp) const {
    return lamps_[lamp].radius > 0 || lamps_[lamp].angular_diameter > 0 || !openings_[lamp].faces.empty();
  }

  /// One lamp's light at a point, over the probability of having chosen this lamp; W/m2 per band.
  struct Sample {
    Rgb irradiance;
    Vec3 way;             ///< from the point to where the light comes from, or out of the scene
    double distance = 0;  ///< length of that way in which a medium can absorb
  };
  /// Returns an unbiased sample of the irradiance at a point; nothing if no lamp can bring any. `choice` and `at` are uniform.
  std::optional<Sample> sample(Vec3 point, Vec3 normal, double choice, UnitPair at) const;
  /// Returns a sample of one lamp, chosen with probability 1.
  Sample sample_of(std::size_t lamp, Vec3 point, Vec3 normal, UnitPair at) const;

  /// Returns the distance from a point in a direction (unit) to where it leaves the scene's bounding box.
  double way_out(Vec3 point, Vec3 direction) const;

 private:
  /// The faces from which a luminaire shines, and its intensities by direction. Other lamps have no faces and no web.
  struct Opening {
    std::vector<OpeningFace> faces;
    double area = 0;
    std::optional<HungWeb> web;
    double greatest = 0;  ///< intensity of the web
  };
  Sample sample_of_opening(std::size_t lamp, Vec3 point, Vec3 normal, UnitPair at) const;
  /// Returns the intensity of a lamp in a direction (unit), as a factor of Light::intensity.
  double share_of_intensity(std::size_t which, Vec3 direction) const;
  Rgb unblocked(std::size_t which, Vec3 point, Vec3 normal) const;

  std::vector<Opening> openings_;  ///< by lamp
  std::vector<Light> lamps_;       ///< places and radii in local units; intensity so that E = I cos / d2 holds in them
  Vec3 low_, high_;                ///< bounding box of the scene
};

}  // namespace alvor
