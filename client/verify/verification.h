#pragma once
// Compares a solution with path tracing.

#include "client/verify/error_statistics.h"
#include "client/verify/irradiance_estimate.h"
#include "meshing/display_mesh.h"

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace alvor {

struct VerifyOptions {
  std::size_t points = 1000;  ///< >= 1
  TraceOptions trace;         ///< its seed also draws the points
};

/// How a point counts in the comparison. Hidden: it lies under or inside a solid, where there is no light and nobody can look.
/// Dark: neither the truth nor the solution has light.
enum class Standing { counts, hidden, dark };

struct VerifiedPoint {
  SurfacePoint at;
  IrradianceEstimate truth;
  Rgb solution;     ///< irradiance, W/m2
  double told = 0;  ///< told error of its mean over the bands (DisplayMesh::errors), W/m2; NaN if none is told
  Standing standing = Standing::counts;

  ComparedPoint compared() const { return {solution.mean(), truth.mean().mean(), truth.variance_of_band_mean()}; }
  /// Returns the solution's irradiance minus the truth, W/m2, bands averaged.
  double error() const { return solution.mean() - truth.mean().mean(); }
  /// Returns the part of |error()| that exceeds the 95 % noise of the truth, W/m2. Sorting by it finds points that are wrong and
  /// not only noisy.
  double certain_error() const;
};

/// How the errors that a solution tells of itself compare with the truth. The truth's own noise is added to them.
struct ToldErrors {
  double nrmse = 0;                       ///< RMS of the told errors over the mean of the true irradiance
  double within_one = 0, within_two = 0;  ///< share of the points whose error is within so many told errors
};

struct Verification {
  std::vector<VerifiedPoint> points;  ///< all points that were drawn
  std::size_t hidden = 0;             ///< points under or inside a solid, see PathTracer::is_enclosed
  std::size_t hidden_lit = 0;         ///< hidden points at which the solution has light nevertheless
  std::size_t dark = 0;               ///< points not hidden where neither paths nor solution have light
  std::uint64_t paths = 0;            ///< paths per point
  ErrorStatistics errors;             ///< over the points that count, neither hidden nor dark
  std::optional<ToldErrors> told;     ///< over the same points, if the solution tells errors
};

/// Thrown where a solution cannot belong to the scene. what() is one line, without the file's name.
struct MismatchError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Throws MismatchError if the bounding boxes differ: the solution belongs to another scene, or to this one in other units.
/// Requires: at least one face with area, !solution.triangles.empty().
void require_same_box(const Scene& scene, const DisplayMesh& solution);

/// Compares a solution with path tracing at random points of the scene. Throws MismatchError. Requires: !find_fault(scene), at
/// least one face with area, !solution.triangles.empty().
Verification verify(const Scene& scene, const DisplayMesh& solution, const VerifyOptions& options);

/// Returns the points with the largest certain error, worst first, of those that count.
std::vector<VerifiedPoint> worst_points(const Verification& verification, std::size_t count);

/// Returns a CSV text with a header and one line per point: x,y,z,nx,ny,nz,truth_r..b,standard_error_r..b,solution_r..b,
/// told_error; W/m2.
std::string verified_csv(std::span<const VerifiedPoint> points);

}  // namespace alvor
