#include "client/verify/gather.h"

#include "client/picture/tone_map.h"
#include "client/verify/cosine_direction.h"
#include "client/verify/irradiance_estimate.h"
#include "client/verify/sight_line.h"
#include "radiosity/form_factors/form_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

constexpr std::uint32_t rounds = 64, rays_per_round = 64;
/// Total of shadow rays; they are shared among emitting triangles by the most that each could send, with a minimum for each.
constexpr double shadow_rays = 2048;
constexpr std::uint32_t least_shadow_rays = 4;
constexpr std::uint32_t trial_rays = 128;
constexpr double rays_of_soft_lamp = 256, rays_of_soft_lamps = 8192;  // of each at most, and of all together
/// Fraction of a shadow ray's length by which it ends before the emitter, so that in float32 it does not hit it.
constexpr double before_emitter = 1e-5;

// The streams of random numbers of one point.
enum Purpose : std::uint64_t { trial, indirect, direct, lamp };

/// The irradiance from one emitting triangle if nothing blocks it.
struct Unblocked {
  std::uint32_t triangle;
  Rgb irradiance;
};

/// Returns whether the surface emits at a vertex. Light that comes through it from behind does not count.
bool emits_at(const DisplayMesh& mesh, std::uint32_t vertex) {
  constexpr float rounded_up = 1 + 1e-6F;  // radiosity is rounded to 6e-8
  const RgbF& received = mesh.irradiance[vertex];
  return emits(mesh.radiosity[vertex], mesh.transmitted.empty() ? received : received + rounded_up * mesh.transmitted[vertex]);
}

}  // namespace

Gatherer::Gatherer(const DisplayMesh& mesh, const TriangleCaster& caster, const Rgb& absorption)
    : mesh_(mesh),
      caster_(caster),
      radiosity_(mesh),
      medium_{absorption},
      lamps_(mesh.lights, {{}, 1}, mesh.positions),
      skies_(mesh.lights),
      is_emitter_(mesh.triangles.size()),
      transmittance_(mesh) {
  const auto vertex_emits = [&](std::uint32_t vertex) { return emits_at(mesh, vertex); };
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    is_emitter_[t] = std::ranges::any_of(mesh.triangles[t], vertex_emits);
    if (is_emitter_[t]) emitters_.push_back(t);
  }
}

std::optional<GatheredIrradiance> Gatherer::gather(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const {
  if (is_enclosed(point, stream)) return std::nullopt;
  const GatheredIrradiance first = from_emitters(point, normal, stream, effort),
                           second = from_lamps(point, normal, stream, effort),
                           third = from_other_surfaces(point, normal, stream, effort);
  return GatheredIrradiance{first.irradiance + second.irradiance + third.irradiance, third.irradiance,
                            std::hypot(first.standard_error, second.standard_error, third.standard_error), third.told_error};
}

Rgb Gatherer::through(const TriangleCaster::Hit& hit, Vec3 direction) const {
  const Material* const pane = transmittance_.pane(hit.triangle);
  if (!pane) return {};
  const bool is_seen_by_twin = pane->two_sided && !meets_front(hit.triangle, direction);
  return is_seen_by_twin ? Rgb{1, 1, 1} : transmittance_.at(hit.triangle, hit.u, hit.v);
}

Rgb Gatherer::passing(Vec3 from, Vec3 to) const {
  return transmittance_between(caster_, from, to, transmittance_.has_panes(),
                               [&](const TriangleCaster::Hit& hit, Vec3 direction) { return through(hit, direction); });
}

bool Gatherer::meets_front(std::uint32_t triangle, Vec3 direction) const {
  const Vec3 a = corner(triangle, 0), area = cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
  return dot(area, direction) < 0;
}

/// Returns pi times the radiance that arrives at a point from a direction, without that of emitters and lamps.
Gatherer::Arriving Gatherer::from_direction(Vec3 point, Vec3 direction) const {
  Arriving arriving;
  Rgb share{1, 1, 1};
  std::vector<std::uint32_t> passed;
  while (passed.size() < TriangleCaster::most_passed && !share.is_zero()) {
    const auto hit = caster_.cast(point, direction, passed);
    if (!hit) {
      if (skies_.empty()) return arriving;
      const Rgb sky = std::numbers::pi * skies_.radiance(direction);
      arriving.light += share * medium_.transmittance(lamps_.way_out(point, direction)) * sky;
      return arriving;
    }
    if (meets_front(hit->triangle, direction) && !is_emitter_[hit->triangle]) {
      const Rgb light = share * medium_.transmittance(hit->distance) * radiosity_.at(hit->triangle, hit->u, hit->v);
      arriving.light += light;
      arriving.error += light.mean() * relative_error(*hit);
    }
    share = share * through(*hit, direction);
    passed.push_back(hit->triangle);
  }
  return arriving;
}

/// Returns the told error of the irradiance where a triangle is hit, over the irradiance; at most 1.
double Gatherer::relative_error(const TriangleCaster::Hit& hit) const {
  if (mesh_.errors.empty()) return 0;
  const auto& [a, b, c] = mesh_.triangles[hit.triangle];
  const double received =
      (1 - hit.u - hit.v) * mesh_.irradiance[a].mean() + hit.u * mesh_.irradiance[b].mean() + hit.v * mesh_.irradiance[c].mean();
  return received > 0 ? std::min(1.0, error_at(mesh_, hit.triangle, hit.u, hit.v) / received) : 0;
}

bool Gatherer::is_enclosed(Vec3 point, std::uint64_t stream) const {
  PathRandom random(stream, trial, 0);
  const EvenPairs directions(random);
  std::uint32_t fronts = 0, backs = 0;
  for (std::uint32_t n = 0; n < trial_rays; ++n) {
    const Vec3 direction = uniform_direction(directions[n]);
    auto hit = caster_.cast(point, direction);
    std::vector<std::uint32_t> passed;
    while (hit && passed.size() < TriangleCaster::most_passed && !through(*hit, direction).is_zero()) {
      passed.push_back(hit->triangle);
      hit = caster_.cast(point, direction, passed);
    }
    if (hit) ++(meets_front(hit->triangle, direction) ? fronts : backs);
  }
  return backs > 0 && backs >= fronts;
}

GatheredIrradiance Gatherer::from_emitters(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const {
  std::vector<Unblocked> unblocked;
  double total = 0;
  for (const std::uint32_t t : emitters_) {
    const std::array<Vec3, 3> corners{corner(t, 0), corner(t, 1), corner(t, 2)};
    const double form_factor = point_to_polygon(point, normal, corners);
    if (form_factor <= 0) continue;
    unblocked.push_back({t, form_factor * radiosity_.of_what_is_there(t, 1.0 / 3, 1.0 / 3)});
    total += unblocked.back().irradiance.mean();
  }
  GatheredIrradiance sum;
  double variance = 0;
  for (const auto& [triangle, most] : unblocked) {
    const auto rays = least_shadow_rays + static_cast<std::uint32_t>(effort * shadow_rays * most.mean() / total);
    const VisibleShare share = visible_share(point, normal, triangle, rays, stream);
    sum.irradiance += share.mean * most;
    variance += most.mean() * most.mean() * share.variance;
  }
  sum.standard_error = std::sqrt(variance);
  return sum;
}

GatheredIrradiance Gatherer::from_lamps(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const {
  GatheredIrradiance all;
  double variance = 0;
  const double share =
      std::min<double>(rays_of_soft_lamp, rays_of_soft_lamps / static_cast<double>(std::max<std::size_t>(1, lamps_.size())));
  const std::uint32_t soft_rays = std::max(least_shadow_rays, static_cast<std::uint32_t>(effort * share));
  for (std::size_t l = 0; l < lamps_.size(); ++l) {
    PathRandom random(stream, lamp, l);
    const EvenPairs places(random);
    const std::uint32_t rays = lamps_.is_soft(l) ? soft_rays : 1;
    Rgb sum;
    double squares = 0;
    for (std::uint32_t n = 0; n < rays; ++n) {
      const Lamps::Sample sample = lamps_.sample_of(l, point, normal, places[n]);
      if (sample.irradiance.is_zero()) continue;
      const Rgb arriving = passing(point, point + sample.way) * medium_.transmittance(sample.distance) * sample.irradiance;
      sum += arriving;
      squares += arriving.mean() * arriving.mean();
    }
    const Rgb mean = sum * (1.0 / rays);
    all.irradiance += mean;
    variance += std::max(0.0, squares / rays - mean.mean() * mean.mean()) / rays;
  }
  all.standard_error = std::sqrt(variance);
  return all;
}

Gatherer::VisibleShare Gatherer::visible_share(Vec3 point, Vec3 normal, std::uint32_t triangle, std::uint32_t rays,
                                               std::uint64_t stream) const {
  PathRandom random(stream, direct, triangle);
  const EvenPairs places(random);
  const Vec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2), area = cross(b - a, c - a);
  // A ratio estimate: sums of the kernel cos cos / r2, up to a factor, and of the kernel times the light that arrives.
  Rgb arriving;
  double all = 0, all_squared = 0, product = 0, arriving_squared = 0, used = 0;
  for (std::uint32_t n = 0; n < rays; ++n) {
    const auto [u, v] = places[n];
    const double edge = std::sqrt(u), along_b = edge * (1 - v), along_c = edge * v;
    const Vec3 place = a + along_b * (b - a) + along_c * (c - a), way = place - point;
    const double kernel = std::max(0.0, dot(normal, way)) * std::max(0.0, -dot(area, way)) / std::pow(dot(way, way), 2);
    if (!(kernel > 0)) continue;
    ++used;
    all += kernel;
    all_squared += kernel * kernel;
    const double there = transmittance_.opacity_at(triangle, along_b, along_c);
    Rgb light;
    if (there > 0)
      light = kernel * there * medium_.transmittance(length(way)) * passing(point, lerp(place, point, before_emitter));
    arriving += light;
    product += kernel * light.mean();
    arriving_squared += light.mean() * light.mean();
  }
  if (used < 2) return {{1, 1, 1}, 0.25};  // only a sliver lies above the horizon
  const Rgb mean = arriving * (1 / all);
  const double m = mean.mean();
  return {mean, std::max(0.0, arriving_squared - 2 * m * product + m * m * all_squared) / (all * all) * used / (used - 1)};
}

GatheredIrradiance Gatherer::from_other_surfaces(Vec3 point, Vec3 normal, std::uint64_t stream, double effort) const {
  IrradianceEstimate estimate;
  double error = 0;
  const std::uint32_t count = std::max(2U, static_cast<std::uint32_t>(effort * rounds));
  for (std::uint32_t round = 0; round < count; ++round) {
    PathRandom random(stream, indirect, round);
    const EvenPairs directions(random);
    Rgb sum;
    for (std::uint32_t n = 0; n < rays_per_round; ++n) {
      const Arriving arriving = from_direction(point, cosine_direction(normal, directions[n]));
      sum += arriving.light;
      error += arriving.error / (rays_per_round * count);
    }
    estimate.add(sum * (1.0 / rays_per_round));
  }
  return {estimate.mean(), estimate.mean(), std::sqrt(estimate.variance_of_band_mean()), error};
}

}  // namespace alvor
