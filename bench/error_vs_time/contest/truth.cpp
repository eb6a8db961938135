#include "bench/error_vs_time/contest/truth.h"

#include "bench/error_vs_time/contest/truth_file.h"
#include "client/verify/irradiance_estimate.h"
#include "client/verify/probe.h"
#include "client/verify/surface_points.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <limits>
#include <stdexcept>

namespace alvor::bench {

namespace {

constexpr std::uint64_t look_around_stream = ~1ull;  // no path uses this stream
constexpr std::uint32_t look_around_rays = 256;
// Standard error of a point's truth, as a share of it, above which it is not compared with a told error. It is that of 25 paths
// that bring the same light: with fewer, their mean is far from normally distributed, and most points have too little light and
// too small a variance. So it is in the dark rooms of the enfilade, where few of 32 000 paths find light.
constexpr double known_to = 0.2;

double mean_of(std::span<const TruePoint> points) {
  double sum = 0;
  for (const TruePoint& point : points) sum += point.irradiance;
  return sum / static_cast<double>(points.size());
}

Truth traced(const Scene& scene, const SceneSettings& wanted, std::uint64_t seed) {
  const std::clock_t begin = std::clock();
  const PathTracer tracer(scene);
  const auto points = draw_surface_points(scene, wanted.truth_points, seed);
  const auto found = trace_irradiance(tracer, points, {.paths = wanted.truth_paths, .seed = seed});
  Truth truth;
  for (std::size_t n = 0; n < points.size(); ++n)
    truth.points.push_back({points[n], found[n].mean().mean(), found[n].variance_of_band_mean()});
  const double mean = mean_of(truth.points);
  for (std::size_t n = 0; n < points.size(); ++n) {
    TruePoint& point = truth.points[n];
    point.is_hidden = !is_surely_lit(point.irradiance, point.variance, mean) &&
                      tracer.is_enclosed(point.at, look_around_rays, PathRandom(seed, n, look_around_stream));
  }
  truth.paths = std::uint64_t{found.front().rounds()} * RoundPlan(wanted.truth_paths).paths_per_round;
  truth.cpu_s = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  return truth;
}

/// Returns whether a point counts where `estimate` is held against its truth.
bool counts(const TruePoint& point, double estimate) {
  const bool is_dark = point.irradiance == 0 && estimate == 0;
  return !point.is_hidden && !is_dark;
}

std::vector<ProbeSample> samples_of(const DisplayMesh& solution, const Truth& truth) {
  std::vector<ProbePoint> asked;
  for (const TruePoint& point : truth.points) asked.push_back({point.at.position, point.at.normal});
  std::vector<ProbeSample> samples = probe_surfaces(solution, asked);
  if (std::ranges::any_of(samples, [](const ProbeSample& sample) { return std::isinf(sample.distance); }))
    throw std::runtime_error("a solution has no surface where its scene has one");
  return samples;
}

}  // namespace

std::size_t Truth::hidden() const { return static_cast<std::size_t>(std::ranges::count(points, true, &TruePoint::is_hidden)); }

Truth find_truth(const Scene& scene, const SceneSettings& scene_settings, const Settings& settings) {
  const auto path = settings.truth_folder / (scene_settings.name + ".txt");
  const std::string question = truth_question(scene, scene_settings, settings.truth_seed);
  if (auto kept = read_truth(path, question)) return *std::move(kept);
  Truth truth = traced(scene, scene_settings, settings.truth_seed);
  write_truth(path, question, truth);
  return truth;
}

ErrorStatistics errors_of(std::span<const double> estimates, const Truth& truth) {
  // NaN would otherwise look like no error in the statistics.
  if (!std::ranges::all_of(estimates, [](double estimate) { return std::isfinite(estimate); }))
    throw std::runtime_error("a solution has irradiance that is not finite");
  std::vector<ComparedPoint> compared;
  for (std::size_t n = 0; n < truth.points.size(); ++n) {
    const TruePoint& point = truth.points[n];
    if (counts(point, estimates[n])) compared.push_back({estimates[n], point.irradiance, point.variance});
  }
  return error_statistics(compared);
}

ErrorStatistics errors_of(const DisplayMesh& solution, const Truth& truth) {
  std::vector<double> estimates;
  for (const ProbeSample& sample : samples_of(solution, truth)) estimates.push_back(widen(sample.irradiance).mean());
  return errors_of(estimates, truth);
}

double within_two_told(const DisplayMesh& solution, const Truth& truth) {
  const std::vector<ProbeSample> samples = samples_of(solution, truth);
  double count = 0, within = 0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const TruePoint& point = truth.points[n];
    const double irradiance = widen(samples[n].irradiance).mean();
    const bool is_known = point.irradiance > 0 && std::sqrt(point.variance) <= known_to * point.irradiance;
    if (!counts(point, irradiance) || !is_known) continue;
    count += 1;
    within += std::abs(irradiance - point.irradiance) <= 2 * std::hypot(samples[n].error, std::sqrt(point.variance));
  }
  return count > 0 ? within / count : std::numeric_limits<double>::quiet_NaN();
}

ErrorStatistics errors_of_itself(const Truth& truth) {
  std::vector<double> same;
  for (const TruePoint& point : truth.points) same.push_back(point.irradiance);
  return errors_of(same, truth);
}

}  // namespace alvor::bench
