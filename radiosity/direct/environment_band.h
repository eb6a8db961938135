#pragma once
// The radiance of an environment map in one band, and directions drawn from it.

#include "meshing/light.h"
#include "radiosity/direct/distant_radiance.h"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// The distribution over directions of the light that an environment sends in one band, or in bands that are alike, with an
/// integral over all directions of 1: it is a radiance in multiples of colour(), and a density of directions. Immutable.
class EnvironmentBand final : public DistantRadiance {
 public:
  /// `bands` weighs the bands of the map. Requires: !fault_in(environment), and a weighted map that is not black.
  EnvironmentBand(const Light& environment, const Rgb& bands);

  /// Returns the irradiance that the radiance 1 stands for, W/m2 per band: the integral over all directions.
  const Rgb& colour() const { return colour_; }
  /// Returns the radiance of the pixel in which a direction lies.
  double radiance(Vec3 towards) const { return radiance_[grid_.pixel_at(axes_.to_grid(towards))]; }
  /// Returns a direction by the density radiance(), for `at` uniform in the unit square.
  Vec3 drawn(double u, double v) const;
  /// Returns the irradiance of an open surface: the sum over groups of pixels, of which those that the horizon cuts are taken to
  /// lie in the middle of their light.
  double irradiance(Vec3 normal) const;
  Vec3 up() const { return axes_.up; }

  double smooth_radiance(Vec3 towards) const override;
  std::optional<Vec3> zenith() const override { return std::nullopt; }

 private:
  void fill_sums();
  void fill_groups();

  const EnvironmentAxes axes_;
  const SphereGrid grid_;
  Rgb colour_;
  std::vector<double> radiance_;     ///< by pixel, 1/sr
  std::vector<double> of_rows_;      ///< sums of what the rows send, from the zenith down to each
  std::vector<double> within_rows_;  ///< by pixel: sums within its row, up to it
  std::vector<float> x_, y_, z_;     ///< by group of pixels: what it sends times its direction, axes of the scene
  SphereGrid smooth_grid_;
  std::vector<double> smooth_;  ///< radiance by pixel of the smooth grid
};

/// Returns the bands of an environment that light alike, each as weights for EnvironmentBand: one entry if the colour is the same
/// in all directions, within 1 % of the light; else one for each band that is not black.
std::vector<Rgb> bands_of(const EnvironmentMap& map);

}  // namespace alvor
