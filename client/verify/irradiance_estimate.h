#pragma once
// Traces irradiance at many points, with the same number of paths each, and estimates its error.

#include "client/verify/path_tracer.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace alvor {

/// The mean of equal rounds of paths, and its variance.
class IrradianceEstimate {
 public:
  void add(const Rgb& round);

  std::uint32_t rounds() const { return rounds_; }
  const Rgb& mean() const { return mean_; }  ///< W/m2
  /// Returns the variance of mean(), per band. Unbiased, however the rounds sample. Requires: rounds() >= 2.
  Rgb variance() const;
  /// Returns the variance of mean().mean(). Bands share their paths, so it is not the variance of independent bands. Requires:
  /// rounds() >= 2.
  double variance_of_band_mean() const;

 private:
  double times_freedom() const { return static_cast<double>(rounds_) * (rounds_ - 1.0); }

  std::uint32_t rounds_ = 0;
  Rgb mean_, squares_;  ///< sums of squared deviations from the mean (Welford 1962)
  double band_mean_squares_ = 0;
};

struct TraceOptions {
  std::uint64_t paths = 1000;  ///< paths per point, >= 2; rounded up, see RoundPlan
  std::uint64_t seed = 1;
  int threads = 0;                                                ///< 0: as many as the machine has
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< the first two rounds are run in any case
  std::function<void(double)> on_progress;                        ///< called with the fraction done, from the calling thread
};

/// Divides paths into rounds. A round's size is a power of two, up to 64 and at most a sixteenth of all paths: many rounds are
/// needed to estimate the variance, large ones to spread their paths evenly.
struct RoundPlan {
  explicit RoundPlan(std::uint64_t paths);
  std::uint32_t paths_per_round;
  std::uint32_t rounds;  ///< >= 2
};

/// Share of the mean irradiance of a scene's surfaces that paths may bring to a place inside a solid: few slip through the seams
/// between faces, where float32 traversal is not watertight. Chosen.
inline constexpr double slipped_light = 1e-3;
/// Returns whether more light arrives at a point than may slip into a solid: its irradiance, less two standard deviations, is
/// above that share of `mean_of_all`.
bool is_surely_lit(double irradiance, double variance, double mean_of_all);

/// Returns one estimate per point, in order. The result depends only on the scene, the points, the paths and the seed, not on the
/// number of threads. All points have the same number of rounds; fewer than planned only if time ran out.
std::vector<IrradianceEstimate> trace_irradiance(const PathTracer& tracer, std::span<const SurfacePoint> points,
                                                 const TraceOptions& options);

}  // namespace alvor
