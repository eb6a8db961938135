#include "client/verify/path_tracer.h"

#include "client/verify/cosine_direction.h"
#include "client/verify/sight_line.h"
#include "radiosity/rays/triangle_caster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace alvor {

namespace {

/// Height at which rays start above their surface, as a fraction of the extent: twenty times the rounding of float32, so that no
/// ray hits the surface it leaves.
constexpr double off_surface = 1e-6;

/// Paths of higher throughput always continue: ending them at their first bend would undo the even spread of directions. On the
/// Cornell box 0.5 gives 43 % less variance for the same time than 1; 0.25 gives no more.
constexpr double dim = 0.5;

/// Returns the coordinates along the sides of a triangle of a place that is uniform by area.
UnitPair place_in_triangle(UnitPair at) {
  const double edge = std::sqrt(at.u);
  return {edge * (1 - at.v), edge * at.v};
}

/// Returns the balance heuristic's weight of a sample, given the densities with which the two ways would have found the same
/// place.
double share_of(double density, double other_density) { return density / (density + other_density); }

}  // namespace

PathTracer::PathTracer(const Scene& scene) : clear_(scene.absorption.is_zero()) {
  const std::vector<Facet> facets = facets_of(scene);
  extent_ = extent_of(facets);
  lamps_ = Lamps(scene.lights, extent_, scene.vertices);
  skies_ = Skies(scene.lights);
  absorption_ = scene.absorption * extent_.longest_side;
  add_surfaces(scene, facets);
  std::vector<Vec3> corners;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const Surface& s : surfaces_) {
    const auto first = static_cast<std::uint32_t>(corners.size());
    corners.insert(corners.end(), {s.corner, s.corner + s.side_u, s.corner + s.side_v});
    triangles.push_back({first, first + 1, first + 2});
  }
  caster_ = std::make_unique<const TriangleCaster>(corners, triangles, Traversal::watertight);
}

PathTracer::~PathTracer() = default;

void PathTracer::add_surfaces(const Scene& scene, std::span<const Facet> facets) {
  const double scale = 1 / extent_.longest_side;
  std::vector<EmittingTriangle> lights;
  for (const Facet& facet : facets) {
    const Material& material = scene.materials[scene.faces[facet.face].material];
    const auto& [a, b, c] = facet.corners;
    surfaces_.push_back({(a - extent_.centre) * scale, (b - a) * scale, (c - a) * scale, facet.normal, material.emission,
                         material.reflectance, material.two_sided, static_cast<std::uint32_t>(lights.size()),
                         material.regular_transmittance, material.texture, facet.texture_points, facet.colours,
                         material.diffuse_transmittance});
    const Surface& s = surfaces_.back();
    has_panes_ |= s.is_pane();
    if (material.emission.is_zero()) continue;
    surface_of_light_.push_back(static_cast<std::uint32_t>(surfaces_.size() - 1));
    lights.push_back({s.corner, s.side_u, s.side_v, s.normal, facet.area * scale * scale, s.emission, s.two_sided});
  }
  lights_ = EmitterTree(std::move(lights));
}

Rgb PathTracer::irradiance(const SurfacePoint& point, std::uint32_t paths, PathRandom random) const {
  if (lights_.empty() && lamps_.empty() && skies_.empty()) return {};
  const Bend start = start_at(point);
  const EvenPairs lights(random), directions(random);
  Rgb sum;
  for (std::uint32_t n = 0; n < paths; ++n) sum += path(start, {lights[n], directions[n]}, random);
  return sum * (1.0 / paths);
}

bool PathTracer::is_enclosed(const SurfacePoint& point, std::uint32_t rays, PathRandom random) const {
  const Bend start = start_at(point);
  const EvenPairs directions(random);
  std::uint32_t backs = 0, ends = 0;
  for (std::uint32_t n = 0; n < rays; ++n)
    backs += behind_panes(start, cosine_direction(start.normal, directions[n])).is_black_back();
  if (2 * backs <= rays) return false;
  constexpr double grazing = 2e-4;  // sine of the angle between ray and surface
  constexpr int most_bends = 6;     // more lead from a gap into the room, where some black back is met
  constexpr double nearly_all = 0.9;
  for (std::uint32_t n = 0; n < rays; ++n) {
    Met met = behind_panes(start, cosine_direction(start.normal, {directions[n].u, 1 - grazing * grazing}));
    for (int bend = 0; met.surface && bend < most_bends; ++bend)
      met = behind_panes(met.bend, cosine_direction(met.bend.normal, random.pair()));
    ends += met.is_black_back();
  }
  return ends > nearly_all * rays;
}

PathTracer::Bend PathTracer::start_at(const SurfacePoint& point) const {
  const Vec3 place = (point.position - extent_.centre) / extent_.longest_side;
  return {place + off_surface * point.normal, point.normal};
}

Rgb PathTracer::path(Bend bend, Choices choices, PathRandom& random) const {
  Rgb arriving, throughput{1, 1, 1};
  for (;;) {
    arriving += throughput * from_chosen_light(bend, choices.light);
    if (!lamps_.empty()) arriving += throughput * from_lamps(bend, random);
    if (!skies_.surroundings().empty()) arriving += throughput * from_surroundings(bend, random.pair());
    const Vec3 direction = cosine_direction(bend.normal, choices.direction);
    const Met met = has_panes_ ? follow(bend, direction, random, throughput) : meet(bend, direction);
    if (!met.surface) return met.is_outside ? arriving + throughput * from_skies(bend, direction) : arriving;
    if (!clear_) throughput = throughput * transmittance(met.distance);
    if (!met.surface->emission.is_zero()) arriving += throughput * from_met_light(bend, direction, met);
    bend = bend_at(met, random, throughput);
    const double survival = std::min(1.0, throughput.max() / dim);
    if (!(random.number() < survival)) return arriving;
    throughput *= 1 / survival;
    choices = {random.pair(), random.pair()};
  }
}

// Directions by cosine: the mean of pi times the radiance is the irradiance. Environments are sampled by their radiance, too.
Rgb PathTracer::from_skies(const Bend& bend, Vec3 direction) const {
  if (skies_.empty()) return {};
  Rgb radiance = skies_.of_skies(direction);
  if (const Surroundings& all = skies_.surroundings(); !all.empty())
    radiance += share_of(dot(bend.normal, direction) / std::numbers::pi, all.density(direction)) * all.radiance(direction);
  const Rgb arriving = std::numbers::pi * radiance;
  return clear_ ? arriving : arriving * transmittance(lamps_.way_out(bend.place, direction));
}

Rgb PathTracer::from_surroundings(const Bend& bend, UnitPair choice) const {
  const Surroundings& all = skies_.surroundings();
  const Vec3 direction = all.sample(choice);
  const double cosine = dot(bend.normal, direction), density = all.density(direction),
               out = lamps_.way_out(bend.place, direction);
  if (cosine <= 0 || density <= 0) return {};
  const Rgb passed = passing(bend.place, bend.place + (out + 0.01) * direction);
  if (passed.is_zero()) return {};
  const Rgb arriving = passed * (share_of(density, cosine / std::numbers::pi) * cosine / density * all.radiance(direction));
  return clear_ ? arriving : arriving * transmittance(out);
}

Rgb PathTracer::from_lamps(const Bend& bend, PathRandom& random) const {
  const auto sample = lamps_.sample(bend.place, bend.normal, random.number(), random.pair());
  if (!sample) return {};
  const Rgb arriving = passing(bend.place, bend.place + sample->way) * sample->irradiance;
  return clear_ ? arriving : arriving * transmittance(sample->distance);
}

// `height / (distance pi)` is the density of directions by cosine, `light_density` that of choosing a place on a light. A sample
// of the latter is emission / pi * cosine / light_density times its weight; this equals the emission times the weight of the
// other way.
Rgb PathTracer::from_chosen_light(const Bend& bend, UnitPair choice) const {
  const auto chosen = lights_.choose(bend.place, bend.normal, choice.u);
  if (!chosen) return {};
  const EmittingTriangle& light = lights_[chosen->light];
  const UnitPair at = place_in_triangle({chosen->rest, choice.v});
  const Vec3 on_light = light.corner + at.u * light.side_u + at.v * light.side_v;
  const double seen_side = dot(light.normal, bend.place - on_light) >= 0 ? 1 : -1;
  if (seen_side < 0 && !light.two_sided) return {};
  const Vec3 end = on_light + seen_side * off_surface * light.normal, towards = on_light - bend.place;
  const double distance = length(towards), height = dot(bend.normal, towards), back = std::abs(dot(light.normal, towards));
  if (height <= 0 || back <= 0) return {};
  const double there = surfaces_[surface_of_light_[chosen->light]].opacity_at(at.u, at.v);
  if (there == 0) return {};
  const Rgb passed = there * passing(bend.place, end);
  if (passed.is_zero()) return {};
  const double light_density = chosen->probability * distance * distance * distance / (light.area * back);
  const Rgb light_here = passed * light.emission * share_of(height / (distance * std::numbers::pi), light_density);
  return clear_ ? light_here : light_here * transmittance(distance);
}

Rgb PathTracer::from_met_light(const Bend& bend, Vec3 direction, const Met& met) const {
  const std::uint32_t light = met.surface->light;
  const double chosen = lights_.probability(bend.place, bend.normal, light);
  const double light_density = chosen * met.distance * met.distance / (lights_[light].area * met.cosine);
  return met.surface->emission * share_of(dot(bend.normal, direction) / std::numbers::pi, light_density);
}

PathTracer::Met PathTracer::meet(const Bend& bend, Vec3 direction, std::span<const std::uint32_t> passed) const {
  auto hit = caster_->cast(bend.place, direction, passed);
  if (!hit) return {.is_outside = true};
  if (const Surface& back = surfaces_[hit->triangle]; !back.two_sided && dot(back.normal, direction) >= 0) {
    // The ray may have hit the wrong one of two faces back to back in one place.
    const auto front = caster_->cast_front(bend.place, direction, passed);
    const bool is_wrong = front && front->distance <= hit->distance + off_surface;
    if (!is_wrong && back.through_at(hit->u, hit->v).is_zero()) return {};
    if (is_wrong) hit = front;
  }
  const Surface& s = surfaces_[hit->triangle];
  const double cosine = -dot(s.normal, direction);
  const Vec3 normal = cosine > 0 ? s.normal : -s.normal;
  // Computed from u and v and not along the ray, so that it lies exactly on the surface, however long the ray.
  const Vec3 place = s.corner + hit->u * s.side_u + hit->v * s.side_v;
  Met met{nullptr, {place + off_surface * normal, normal}, hit->distance, std::abs(cosine), hit->u, hit->v};
  if (cosine > 0 || s.two_sided) met.surface = &s;
  if (!s.is_pane()) return met;
  met.opacity = s.opacity_at(hit->u, hit->v);
  met.through = s.through_at(hit->u, hit->v);
  if (!met.through.is_zero()) met.pane = hit->triangle;
  return met;
}

TexturePoint PathTracer::Surface::texture_point_at(double u, double v) const {
  const auto mixed = [&](float TexturePoint::*axis) {
    return static_cast<float>((1 - u - v) * texture_points[0].*axis + u * texture_points[1].*axis + v * texture_points[2].*axis);
  };
  return {mixed(&TexturePoint::s), mixed(&TexturePoint::t)};
}

Rgb PathTracer::Surface::reflectance_at(double u, double v) const {
  const Rgb colour = (1 - u - v) * widen(colours[0]) + u * widen(colours[1]) + v * widen(colours[2]);
  return (texture ? texture->reflectance_at(texture_point_at(u, v)) : reflectance) * colour;
}

Rgb PathTracer::Surface::through_at(double u, double v) const {
  const double there = opacity_at(u, v), hole = 1 - there;
  return there * through + Rgb{hole, hole, hole};
}

/// Returns where a path bends on a surface that it meets, and multiplies `throughput` by what the surface scatters to that side.
/// The side is drawn by chance, so that the expectation is that of both sides.
PathTracer::Bend PathTracer::bend_at(const Met& met, PathRandom& random, Rgb& throughput) {
  const Rgb reflected = met.surface->reflectance_at(met.u, met.v), &scattered = met.surface->scattered;
  if (scattered.is_zero()) {
    throughput = throughput * reflected;
    return met.bend;
  }
  const double chance = reflected.max() / (reflected.max() + scattered.max());
  if (random.number() < chance) {
    throughput = throughput * reflected * (1 / chance);
    return met.bend;
  }
  throughput = throughput * scattered * (1 / (1 - chance));
  return {met.bend.place - 2 * off_surface * met.bend.normal, -met.bend.normal};
}

/// Returns the chance with which a path goes straight on at a pane, instead of ending at its surface.
double PathTracer::Met::chance_to_go_on() const {
  if (!surface) return 1;
  if (!surface->emission.is_zero()) return 1 - opacity / 2;
  return through.max() / (through.max() + opacity * (surface->reflectance.max() + surface->scattered.max()));
}

/// Returns what a ray meets that goes on through all panes.
PathTracer::Met PathTracer::behind_panes(const Bend& bend, Vec3 direction) const {
  std::vector<std::uint32_t> passed;
  Met met = meet(bend, direction);
  while (met.pane && passed.size() < TriangleCaster::most_passed) {
    passed.push_back(*met.pane);
    met = meet(bend, direction, passed);
  }
  return met;
}

/// Follows a path that goes on through panes or ends at one of them, by chance. Multiplies `throughput` so that the expectation
/// is that of both. Holes are always passed.
PathTracer::Met PathTracer::follow(const Bend& bend, Vec3 direction, PathRandom& random, Rgb& throughput) const {
  std::vector<std::uint32_t> passed;
  Met met = meet(bend, direction);
  while (met.pane && passed.size() < TriangleCaster::most_passed) {
    const double chance = met.chance_to_go_on();
    if (!(random.number() < chance)) {
      throughput *= met.opacity / (1 - chance);
      return met;
    }
    throughput = throughput * met.through * (1 / chance);
    passed.push_back(*met.pane);
    met = meet(bend, direction, passed);
  }
  throughput *= met.opacity;
  return met;
}

/// Returns the share of light that goes straight from one place to another, per band.
Rgb PathTracer::passing(Vec3 from, Vec3 to) const {
  return transmittance_between(*caster_, from, to, has_panes_, [&](const TriangleCaster::Hit& hit, Vec3) {
    return surfaces_[hit.triangle].through_at(hit.u, hit.v);
  });
}

Rgb PathTracer::transmittance(double distance) const {
  return {std::exp(-absorption_.r * distance), std::exp(-absorption_.g * distance), std::exp(-absorption_.b * distance)};
}

}  // namespace alvor
