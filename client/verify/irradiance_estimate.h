#pragma once
// Irradiance at many points, each to the same number of paths, with its error.

#include "client/verify/path_tracer.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

namespace alvor {

/// The mean of equal rounds and how far it may be off.
class IrradianceEstimate {
 public:
  void add(const Rgb& round);

  std::uint32_t rounds() const { return rounds_; }
  const Rgb& mean() const { return mean_; }  ///< W/m2
  /// Of mean(), per band: unbiased, whatever the rounds' own sampling was. Requires: rounds() >= 2.
  Rgb variance() const;
  /// Of mean().mean(): not that of independent bands, for they share their paths. Requires: rounds() >= 2.
  double variance_of_band_mean() const;

 private:
  double times_freedom() const { return static_cast<double>(rounds_) * (rounds_ - 1.0); }

  std::uint32_t rounds_ = 0;
  Rgb mean_, squares_;  ///< sums of squared deviations from the mean (Welford 1962)
  double band_mean_squares_ = 0;
};

struct TraceOptions {
  std::uint64_t paths = 1000;  ///< of each point, >= 2; see RoundPlan for what it is rounded up to
  std::uint64_t seed = 1;
  int threads = 0;                                                ///< 0: as many as the machine has
  double time_limit_s = std::numeric_limits<double>::infinity();  ///< no round but the first two is begun after it
  std::function<void(double)> on_progress;                        ///< gets the share of what is done, from the calling thread
};

/// Paths come in rounds of a power of two, up to 64 and no more than a sixteenth of all: many enough that their spread tells
/// the variance, and large enough to be spread evenly.
struct RoundPlan {
  explicit RoundPlan(std::uint64_t paths);
  std::uint32_t paths_per_round;
  std::uint32_t rounds;  ///< >= 2
};

/// One estimate per point, in order. A function of the scene, the points, the paths and the seed: not of the number of threads.
/// All have the same number of rounds; fewer than planned only if time ran out.
std::vector<IrradianceEstimate> trace_irradiance(const PathTracer& tracer, std::span<const SurfacePoint> points,
                                                 const TraceOptions& options);

}  // namespace alvor
