#include "client/verify/irradiance_estimate.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

namespace alvor {

void IrradianceEstimate::add(const Rgb& round) {
  ++rounds_;
  const Rgb before = round - mean_;
  mean_ += before * (1.0 / rounds_);
  const Rgb after = round - mean_;
  squares_ += before * after;
  band_mean_squares_ += before.mean() * after.mean();
}

Rgb IrradianceEstimate::variance() const { return squares_ * (1 / times_freedom()); }

double IrradianceEstimate::variance_of_band_mean() const { return band_mean_squares_ / times_freedom(); }

RoundPlan::RoundPlan(std::uint64_t paths) {
  constexpr std::uint64_t largest = 64, fewest_rounds = 16;
  paths_per_round = static_cast<std::uint32_t>(std::bit_floor(std::clamp(paths / fewest_rounds, std::uint64_t{1}, largest)));
  const std::uint64_t needed = std::min((paths - 1) / paths_per_round + 1, std::uint64_t{~0u});
  rounds = std::max(2u, static_cast<std::uint32_t>(needed));
}

bool is_surely_lit(double irradiance, double variance, double mean_of_all) {
  return irradiance - 2 * std::sqrt(variance) > slipped_light * mean_of_all;
}

std::vector<IrradianceEstimate> trace_irradiance(const PathTracer& tracer, std::span<const SurfacePoint> points,
                                                 const TraceOptions& options) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  const auto out_of_time = [&] { return std::chrono::duration<double>(Clock::now() - begin).count() > options.time_limit_s; };
  const RoundPlan plan(options.paths);
  std::vector<IrradianceEstimate> estimates(points.size());
  tbb::task_arena arena(options.threads > 0 ? options.threads : tbb::task_arena::automatic);
  for (std::uint32_t round = 0; round < plan.rounds && (round < 2 || !out_of_time()); ++round) {
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t n) {
        estimates[n].add(tracer.irradiance(points[n], plan.paths_per_round, PathRandom(options.seed, n, round)));
      });
    });
    if (options.on_progress) options.on_progress((round + 1.0) / plan.rounds);
  }
  return estimates;
}

}  // namespace alvor
