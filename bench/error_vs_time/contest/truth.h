#pragma once
// Computes the true irradiance at random points of a scene.

#include "bench/error_vs_time/contest/settings.h"
#include "client/verify/error_statistics.h"
#include "client/verify/path_tracer.h"
#include "meshing/display_mesh.h"

#include <vector>

namespace alvor::bench {

/// The true irradiance at one point, bands averaged, W/m2.
struct TruePoint {
  SurfacePoint at;
  double irradiance = 0, variance = 0;  ///< `variance` is the variance of the mean over all paths
  bool is_hidden = false;               ///< under or inside a solid, where there is no light and nobody can look
};

struct Truth {
  std::vector<TruePoint> points;
  std::uint64_t paths = 0;  ///< paths per point
  double cpu_s = 0;         ///< CPU time of computing the truth
  bool was_kept = false;    ///< whether it was read from an earlier run's file

  std::size_t hidden() const;
};

/// Reads the truth from the settings' folder, or traces it and stores it there. A stored truth of other points, paths or another
/// scene is not used. Throws FileError if it cannot be stored.
Truth find_truth(const Scene& scene, const SceneSettings& scene_settings, const Settings& settings);

/// Returns the errors of a solution at the points that count, as `alvor verify` does: hidden points do not count, nor points
/// without light in both. Throws std::runtime_error if the solution has no surface there or a value is not finite.
ErrorStatistics errors_of(const DisplayMesh& solution, const Truth& truth);

/// Returns the share of the points that count whose error is within two of the solution's told errors, the noise of the truth
/// added to them. Points whose truth is 0, or has a standard error above a fifth of it, do not count. NaN if none counts.
/// Requires: the solution tells errors.
double within_two_told(const DisplayMesh& solution, const Truth& truth);

/// Returns the errors of other estimates at the truth's points, in order. Throws std::runtime_error if one is not finite.
ErrorStatistics errors_of(std::span<const double> estimates, const Truth& truth);

/// Returns statistics of the truth's own noise.
ErrorStatistics errors_of_itself(const Truth& truth);

}  // namespace alvor::bench
