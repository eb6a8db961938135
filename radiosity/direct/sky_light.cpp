#include "radiosity/direct/sky_light.h"

#include "radiosity/direct/disk_point.h"
#include "radiosity/direct/face_integral.h"
#include "radiosity/form_factors/form_factor.h"
#include "radiosity/form_factors/shadow_cone.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

using std::numbers::pi;

// Steps of the table over normals: angles from the zenith and azimuths; and of the sum over directions that fills it.
constexpr int tilts = 48, turns = 96, rings = 32, sectors = 128;
// Cosine of the angle between a zenith and the side of an exit within which the side stands upright.
constexpr double aligned = 1 - 1e-9;
// Longest side of a triangle over which radiance is looked at in three places, as a share of its distance; and most steps into
// which a side is cut for that. Chosen.
constexpr double widest_triangle = 0.5, most_steps = 6;

/// Returns the irradiance of open surfaces by their normal.
NormalTable table_of(const SkyDome& dome) {
  struct Ray {
    Vec3 direction;
    double brings;  // radiance times solid angle
  };
  const TangentFrame axes(dome.zenith());
  std::vector<Ray> rays;
  for (int ring = 0; ring < rings; ++ring)
    for (int sector = 0; sector < sectors; ++sector) {
      // Even by solid angle, so that the horizon, which tilted faces look at, is as fine as the zenith.
      const double cosine = (ring + 0.5) / rings, sine = std::sqrt(1 - cosine * cosine), turn = 2 * pi * (sector + 0.5) / sectors;
      const Vec3 direction = cosine * dome.zenith() + sine * std::cos(turn) * axes.s + sine * std::sin(turn) * axes.t;
      rays.push_back({direction, dome.radiance(direction) * 2 * pi / (rings * sectors)});
    }
  return {dome.zenith(), tilts, turns, [&](Vec3 normal) {
            double sum = 0;
            for (const Ray& ray : rays) sum += ray.brings * std::max(0.0, dot(ray.direction, normal));
            return sum;
          }};
}

/// Returns the irradiance that a place at the end of `way`, on a plane with this unit normal, brings per area and radiance.
double brought_by_even_radiance(Vec3 way, Vec3 normal, Vec3 normal_of_plane) {
  const double squared = std::max(dot(way, way), nearest_look * nearest_look);
  return std::max(0.0, dot(way, normal)) * std::abs(dot(way, normal_of_plane)) / (squared * squared);
}

Vec3 direction_of(Vec3 way) { return way / std::max(length(way), nearest_look); }

}  // namespace

DomeLight::DomeLight(const LocalScene& scene, std::uint32_t number, const SkyDome& dome, const RelativeLight& colour,
                     double power, std::shared_ptr<const SkyExits> exits)
    : LightSource(number, colour, power), dome_(dome), exits_(std::move(exits)), box_(scene), irradiance_(table_of(dome_)) {}

double DomeLight::unblocked(Vec3, Vec3 normal) const { return irradiance_.at(normal); }

void DomeLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  const Vec3 normal = aim.facing();
  const TangentFrame tangents(normal);
  for (std::size_t o = first; o < last; ++o) {
    const Uv at = aim.at[o];
    const Vec3 direction = normalized(disk_point(tangents, at) + std::sqrt(std::max(0.0, 1 - at.u)) * normal);
    aim.set(o, box_.way_out(aim.start(o), direction) * direction, 1, pi * dome_.radiance(direction));
  }
}

ExitLight::ExitLight(const LocalScene& scene, std::uint32_t number, std::shared_ptr<const DistantRadiance> radiance,
                     const RelativeLight& colour, double power, std::shared_ptr<const SkyExits> exits, std::size_t which)
    : LightSource(number, colour, power),
      radiance_(std::move(radiance)),
      exits_(std::move(exits)),
      which_(which),
      exit_(exits_->exits[which]),
      corners_(exit_.corners()),
      box_(scene),
      zenith_(radiance_->zenith()) {}

/// Returns the irradiance that a point of the exit brings, per area of the exit.
double ExitLight::brings(Vec3 from, Vec3 at, Vec3 normal) const {
  const Vec3 way = from - at;
  const double even = brought_by_even_radiance(way, normal, exit_.normal);
  return even > 0 ? even * radiance_->smooth_radiance(direction_of(way)) : 0;
}

/// Returns the part of the exit through which the sky is seen from a point: above the horizontal plane through the point. A
/// zenith that is not along a side leaves the exit whole, as does light from all directions.
FlatRectangle ExitLight::above_horizon(Vec3 at) const {
  FlatRectangle part = exit_;
  if (!zenith_) return part;
  const double height = dot(part.corner - at, *zenith_);
  const auto cut = [&](Vec3& side) {
    const double rise = dot(side, *zenith_);
    // The horizon lies at this share of the side.
    const double share = std::clamp(-height / rise, 0.0, 1.0);
    if (rise > 0) part.corner += share * side, side = (1 - share) * side;
    else side = share * side;
  };
  const double along_u = std::abs(dot(part.side_u, *zenith_)), along_v = std::abs(dot(part.side_v, *zenith_));
  if (along_u > aligned * length(part.side_u)) cut(part.side_u);
  else if (along_v > aligned * length(part.side_v)) cut(part.side_v);
  return part;
}

double ExitLight::unblocked(Vec3 at, Vec3 normal) const {
  const FlatRectangle part = above_horizon(at);
  const double size_u = length(part.side_u), size_v = length(part.side_v);
  if (!(size_u > 0 && size_v > 0)) return 0;
  const auto point = [&](Uv uv) { return part.at(uv.u, uv.v); };
  const auto brings_here = [&](Vec3 from) { return brings(from, at, normal); };
  return part.area() * FaceIntegral(point, brings_here, size_u, size_v, at).mean();
}

/// Returns the mean of the radiance over a part of the exit, weighted by what even radiance would bring. The part is cut into
/// triangles that are small beside their distance, and each is seen by three points inside, because its sides may lie on the
/// horizon, where the sky ends (the rule is exact for polynomials of degree two: Hammer & Stroud 1956).
double ExitLight::mean_radiance(std::span<const Vec3> part, Vec3 at, Vec3 normal) const {
  double all = 0, bright = 0;
  const auto add = [&](Vec3 from, double area) {
    const Vec3 way = from - at;
    const double weight = area * brought_by_even_radiance(way, normal, exit_.normal);
    all += weight;
    bright += weight * radiance_->smooth_radiance(direction_of(way));
  };
  for (std::size_t c = 2; c < part.size(); ++c) {
    const Vec3 corner = part[0], u = part[c - 1] - corner, v = part[c] - corner;
    const double longest = std::max({length(u), length(v), length(u - v)});
    const double distance = length(corner + (u + v) / 3 - at);
    const int steps = static_cast<int>(std::clamp(std::ceil(longest / (widest_triangle * distance)), 1.0, most_steps));
    const double area = length(cross(u, v)) / (2.0 * steps * steps);
    const auto add_triangle = [&](double a, double b, double side) {  // a corner and the length of its sides, in steps
      const auto place = [&](double x, double y) { return corner + x / steps * u + y / steps * v; };
      const double near = side / 6, far = 4 * near;
      for (const Vec3 inside : {place(a + near, b + near), place(a + far, b + near), place(a + near, b + far)})
        add(inside, area / 3);
    };
    for (int a = 0; a < steps; ++a)
      for (int b = 0; a + b < steps; ++b) {
        add_triangle(a, b, 1);
        if (a + b + 1 < steps) add_triangle(a + 1, b + 1, -1);
      }
  }
  return all > 0 ? bright / all : 0;
}

double ExitLight::through(std::vector<ConvexPolygon>& parts, Vec3 at, Vec3 normal) const {
  std::vector<ConvexPolygon> rest;
  for (std::size_t before = 0; before < which_; ++before) {  // see SkyExits::counts_at
    const ShadowCone counts_there(at, exits_->exits[before].corners());
    rest.clear();
    for (const ConvexPolygon& part : parts) counts_there.cut_from(part, rest);
    parts.swap(rest);
  }
  double sum = 0;
  for (const ConvexPolygon& part : parts) {
    const ConvexPolygon seen = zenith_ ? part_above(part, {*zenith_, dot(*zenith_, at)}) : part;
    if (seen.is_empty()) continue;
    sum += pi * std::abs(point_to_polygon_above(at, normal, seen.corners())) * mean_radiance(seen.corners(), at, normal);
  }
  return sum;
}

void ExitLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  for (std::size_t o = first; o < last; ++o) {
    const Uv at = aim.at[o];
    const Vec3 from = aim.start(o);
    const FlatRectangle part = above_horizon(from);
    const Vec3 target = part.at(at.u, at.v);
    const Vec3 direction = normalized(target - from);
    aim.set(o, box_.way_out(from, direction) * direction, 1, part.area() * brings(target, from, aim.facing()));
    if (aim.there && !exits_->counts_at(which_, from, direction)) (*aim.there)[o] = 0;
  }
}

}  // namespace alvor
