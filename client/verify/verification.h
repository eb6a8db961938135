#pragma once
// A solution against path tracing.

#include "client/verify/error_statistics.h"
#include "client/verify/irradiance_estimate.h"
#include "meshing/display_mesh.h"

#include <stdexcept>
#include <string>
#include <vector>

namespace alvor {

struct VerifyOptions {
  std::size_t points = 1000;  ///< >= 1
  TraceOptions trace;         ///< its seed draws the points too
};

/// What a point says about a solution. Under a solid there is no light, whatever a solution says, and nobody
/// can look.
enum class Standing { counts, hidden, dark };

struct VerifiedPoint {
  SurfacePoint at;
  IrradianceEstimate truth;
  Rgb solution;  ///< irradiance, W/m2
  Standing standing = Standing::counts;

  ComparedPoint compared() const { return {solution.mean(), truth.mean().mean(), truth.variance_of_band_mean()}; }
  /// How far the solution is above the truth, W/m2, bands averaged.
  double error() const { return solution.mean() - truth.mean().mean(); }
  /// What of its size is not noise of the truth, at 95 %: the points where it is large are wrong, not unlucky.
  double certain_error() const;
};

struct Verification {
  std::vector<VerifiedPoint> points;  ///< all that were drawn
  std::size_t hidden = 0;             ///< of them: under or inside a solid, see PathTracer::is_enclosed
  std::size_t hidden_lit = 0;         ///< of the hidden: where the solution has light nevertheless
  std::size_t dark = 0;               ///< not hidden, but no path brought light and the solution has none
  std::uint64_t paths = 0;            ///< of each point
  ErrorStatistics errors;             ///< over the points that count: neither hidden nor dark
};

/// Why a solution cannot be one of the scene. what() is one line, without the file's name.
struct MismatchError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Compares at random points of the scene. Throws MismatchError. Requires: !find_fault(scene), at least one face with area,
/// !solution.triangles.empty().
Verification verify(const Scene& scene, const DisplayMesh& solution, const VerifyOptions& options);

/// Of the points that count those of the largest certain error, the worst first.
std::vector<VerifiedPoint> worst_points(const Verification& verification, std::size_t count);

/// A header and one line per point: x,y,z,nx,ny,nz,truth_r..b,standard_error_r..b,solution_r..b; W/m2.
std::string verified_csv(std::span<const VerifiedPoint> points);

}  // namespace alvor
