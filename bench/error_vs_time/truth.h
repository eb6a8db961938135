#pragma once
// The irradiance that is true, at random points of a scene.

#include "bench/error_vs_time/settings.h"
#include "client/verify/error_statistics.h"
#include "client/verify/path_tracer.h"
#include "meshing/display_mesh.h"

#include <vector>

namespace alvor::bench {

/// Irradiance at one point, bands averaged, W/m2.
struct TruePoint {
  SurfacePoint at;
  double irradiance = 0, variance = 0;  ///< the variance is that of the mean of all paths
  bool is_hidden = false;               ///< under or inside a solid: no light, and nobody can look
};

struct Truth {
  std::vector<TruePoint> points;
  std::uint64_t paths = 0;  ///< of each point
  double cpu_s = 0;         ///< that finding it took
  bool was_kept = false;    ///< from an earlier run

  std::size_t hidden() const;
};

/// Reads the truth from the settings' folder, or traces it and keeps it there. One that was kept for other points, paths or
/// another scene is not taken. Throws FileError where it cannot be kept.
Truth find_truth(const Scene& scene, const SceneSettings& scene_settings, const Settings& settings);

/// Of a solution, at the points that count, as `alvor verify` does: hidden points do not, nor points without light in both.
/// Throws std::runtime_error where the solution has no surface or no finite value.
ErrorStatistics errors_of(const DisplayMesh& solution, const Truth& truth);

/// Of other estimates at the truth's points, in order. Throws std::runtime_error where one is not finite.
ErrorStatistics errors_of(std::span<const double> estimates, const Truth& truth);

/// How well the truth is known.
ErrorStatistics errors_of_itself(const Truth& truth);

}  // namespace alvor::bench
