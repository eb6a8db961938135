#pragma once
// The environment maps of a scene, for the path tracer. Written apart from the solver's (radiosity/direct), so that an error in
// one is seen.

#include "client/verify/path_random.h"
#include "meshing/light.h"

#include <span>
#include <vector>

namespace alvor {

/// Radiance that surrounds a scene, and directions drawn from it: each pixel of each map by the light that it sends, places
/// within a pixel uniform by solid angle. Immutable.
class Surroundings {
 public:
  Surroundings() = default;
  /// Lights that are not environments are left out.
  explicit Surroundings(std::span<const Light> lights);

  bool empty() const { return pixels_.empty(); }
  /// Returns the radiance from a direction (unit), W/m2 sr per band.
  Rgb radiance(Vec3 towards) const;
  /// Returns the density by which sample() finds a direction, 1/sr.
  double density(Vec3 towards) const;
  /// Returns a direction, for `at` uniform in the unit square. Requires: !empty().
  Vec3 sample(UnitPair at) const;

 private:
  struct Sphere {
    Vec3 ahead, right, up;
    std::size_t columns = 0, rows = 0, first = 0;  ///< `first` is the index of its first pixel
  };
  /// Returns the index of the pixel of a map that holds a direction.
  static std::size_t pixel_at(const Sphere& sphere, Vec3 towards);

  std::vector<Sphere> spheres_;
  std::vector<Rgb> pixels_;        ///< radiance, all maps in turn
  std::vector<double> densities_;  ///< by pixel
  std::vector<double> sums_;       ///< of the probabilities of the pixels up to each
};

}  // namespace alvor
