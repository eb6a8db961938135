#pragma once
// Illuminance on the work plane and at the height of faces, from a solution.

#include "client/report/work_plane.h"
#include "client/verify/gather.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace alvor {

/// A value and its standard error, lx, or W/m2 in a radiometric solution.
struct Measured {
  double value = 0, error = 0;
};

/// The light at one point of a grid. Empty where the point lies inside a solid.
struct PointLight {
  std::optional<Measured> horizontal;   ///< on the work plane, facing up
  std::optional<Measured> cylindrical;  ///< mean of the vertical ones over all directions
  /// On vertical planes that face along u, v, -u and -v of the frame.
  std::array<std::optional<double>, 4> vertical;
};

/// Mean, minimum and so on over the points of a grid.
struct PlaneStatistics {
  std::size_t points = 0;
  Measured mean;
  double minimum = 0, maximum = 0;
  double uniformity() const { return mean.value > 0 ? minimum / mean.value : 0; }  ///< U0 = minimum / mean
};

/// Returns nothing if there are no values.
std::optional<PlaneStatistics> statistics_of(std::span<const Measured> values);

struct PlaneHeights {
  double work = 0.75;  ///< of the work plane above the floor, metres
  double face = 1.2;   ///< at which cylindrical and vertical illuminances are computed: of people who sit
};

/// Measures the light at points of a solution: what a photometer would show there.
struct LightMeter {
  const Gatherer& gatherer;
  Quantity quantity = Quantity::radiometric;

  /// Returns nothing inside a solid and outside the room. The error has the noise of rays, and the told errors of the surfaces
  /// that they meet, as if all of these erred alike. `effort`: see Gatherer::gather().
  std::optional<Measured> at(Vec3 point, Vec3 normal, std::uint64_t stream, double effort = 1) const;
};

/// Returns the light on the work plane at the points of a grid, in their order; nothing inside of solids. Uses all cores; the
/// same grid gives the same values.
std::vector<std::optional<Measured>> horizontal_light_on(const Room& room, const WorkGrid& grid, double height,
                                                         const LightMeter& meter);

/// Returns all light at the points of a grid, in their order. Uses all cores; the same grid gives the same values.
std::vector<PointLight> light_on(const Room& room, const WorkGrid& grid, const PlaneHeights& heights, const LightMeter& meter);

/// Returns the told relative error of a solution: the RMS of its errors over the mean of its irradiance, both by area. Nothing if
/// it tells no errors or is dark.
std::optional<double> told_relative_error(const DisplayMesh& mesh);

}  // namespace alvor
