#include "client/verify/verification.h"

#include "client/verify/probe.h"
#include "client/verify/surface_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace alvor {

namespace {

/// Relative rounding of positions in solution files, which are float32.
constexpr double float_step = 1e-6;
/// A stream of random numbers that neither the rounds nor the points use.
constexpr std::uint64_t look_around_stream = ~1ull;

std::string text_of(Vec3 p) {
  std::array<char, 96> text;
  std::snprintf(text.data(), text.size(), "%.6g,%.6g,%.6g", p.x, p.y, p.z);
  return text.data();
}

std::vector<ProbeSample> solution_at(const DisplayMesh& solution, std::span<const SurfacePoint> points) {
  std::vector<ProbePoint> asked;
  for (const SurfacePoint& point : points) asked.push_back({point.position, point.normal});
  std::vector<ProbeSample> samples = probe_surfaces(solution, asked);
  const auto missed = std::ranges::find(samples, std::numeric_limits<double>::infinity(), &ProbeSample::distance);
  if (missed == samples.end()) return samples;
  throw MismatchError("is not a solution of this scene: it has no surface that faces as the scene does at " +
                      text_of(missed->point));
}

/// Returns how a point counts. Only where it is not sure that paths bring light is it necessary to look whether the point is
/// enclosed.
Standing standing_of(const PathTracer& tracer, const VerifiedPoint& point, double mean_truth, PathRandom random) {
  constexpr std::uint32_t rays = 256;
  if (is_surely_lit(point.truth.mean().mean(), point.truth.variance_of_band_mean(), mean_truth)) return Standing::counts;
  if (tracer.is_enclosed(point.at, rays, random)) return Standing::hidden;
  return point.truth.mean().is_zero() && point.solution.is_zero() ? Standing::dark : Standing::counts;
}

double mean_of(std::span<const IrradianceEstimate> truths) {
  double sum = 0;
  for (const IrradianceEstimate& truth : truths) sum += truth.mean().mean();
  return sum / static_cast<double>(truths.size());
}

std::optional<ToldErrors> told_errors_of(const Verification& verification) {
  double count = 0, squares = 0, within_one = 0, within_two = 0;
  for (const VerifiedPoint& point : verification.points) {
    if (point.standing != Standing::counts) continue;
    if (std::isnan(point.told)) return std::nullopt;
    const double told = std::sqrt(point.told * point.told + point.truth.variance_of_band_mean());
    count += 1;
    squares += point.told * point.told;
    within_one += std::abs(point.error()) <= told;
    within_two += std::abs(point.error()) <= 2 * told;
  }
  if (!(verification.errors.mean_truth > 0)) return std::nullopt;
  return ToldErrors{std::sqrt(squares / count) / verification.errors.mean_truth, within_one / count, within_two / count};
}

void sum_up(Verification& verification) {
  std::vector<ComparedPoint> compared;
  for (const VerifiedPoint& point : verification.points) {
    const bool hidden = point.standing == Standing::hidden;
    verification.hidden += hidden;
    verification.hidden_lit += hidden && !point.solution.is_zero();
    verification.dark += point.standing == Standing::dark;
    if (point.standing == Standing::counts) compared.push_back(point.compared());
  }
  verification.errors = error_statistics(compared);
  verification.told = told_errors_of(verification);
}

void append_numbers(std::string& text, std::initializer_list<double> numbers) {
  for (const double number : numbers) {
    std::array<char, 32> digits;
    text.append(digits.data(), static_cast<std::size_t>(std::snprintf(digits.data(), digits.size(), "%.9g,", number)));
  }
}

}  // namespace

double VerifiedPoint::certain_error() const {
  return std::max(0.0, std::abs(error()) - 1.96 * std::sqrt(truth.variance_of_band_mean()));
}

void require_same_box(const Scene& scene, const DisplayMesh& solution) {
  constexpr double alike = 0.01;
  const std::vector<Facet> facets = facets_of(scene);
  const Extent here = extent_of(facets), there = extent_of(solution.positions);
  const double off = length(there.centre - here.centre) + std::abs(there.longest_side - here.longest_side);
  if (off <= alike * here.longest_side + float_step * length(here.centre)) return;
  throw MismatchError("is not a solution of this scene: it is " + std::to_string(there.longest_side) + " m long, about " +
                      text_of(there.centre) + ", and the scene " + std::to_string(here.longest_side) + " m, about " +
                      text_of(here.centre));
}

Verification verify(const Scene& scene, const DisplayMesh& solution, const VerifyOptions& options) {
  require_same_box(scene, solution);
  const std::vector<SurfacePoint> points = draw_surface_points(scene, options.points, options.trace.seed);
  const std::vector<ProbeSample> samples = solution_at(solution, points);
  const PathTracer tracer(scene);
  const std::vector<IrradianceEstimate> truths = trace_irradiance(tracer, points, options.trace);
  const double mean_truth = mean_of(truths);
  Verification verification;
  for (std::size_t n = 0; n < points.size(); ++n) {
    VerifiedPoint point{points[n], truths[n], widen(samples[n].irradiance), samples[n].error};
    point.standing = standing_of(tracer, point, mean_truth, PathRandom(options.trace.seed, n, look_around_stream));
    verification.points.push_back(point);
  }
  verification.paths = std::uint64_t{truths.front().rounds()} * RoundPlan(options.trace.paths).paths_per_round;
  sum_up(verification);
  return verification;
}

std::vector<VerifiedPoint> worst_points(const Verification& verification, std::size_t count) {
  std::vector<VerifiedPoint> worst = verification.points;
  std::erase_if(worst, [](const VerifiedPoint& point) { return point.standing != Standing::counts; });
  std::ranges::stable_sort(worst, std::greater{}, &VerifiedPoint::certain_error);
  worst.resize(std::min(count, worst.size()));
  return worst;
}

std::string verified_csv(std::span<const VerifiedPoint> points) {
  std::string text =
      "x,y,z,nx,ny,nz,truth_r,truth_g,truth_b,standard_error_r,standard_error_g,standard_error_b,solution_r,solution_g,"
      "solution_b,told_error\n";
  for (const VerifiedPoint& p : points) {
    const Rgb mean = p.truth.mean(), variance = p.truth.variance();
    append_numbers(text, {p.at.position.x, p.at.position.y, p.at.position.z, p.at.normal.x, p.at.normal.y, p.at.normal.z});
    append_numbers(text, {mean.r, mean.g, mean.b, std::sqrt(variance.r), std::sqrt(variance.g), std::sqrt(variance.b)});
    append_numbers(text, {p.solution.r, p.solution.g, p.solution.b, p.told});
    text.back() = '\n';
  }
  return text;
}

}  // namespace alvor
