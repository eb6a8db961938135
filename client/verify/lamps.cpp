#include "client/verify/lamps.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace alvor {

namespace {

// Share of the way to a lamp that must be free.
constexpr double nearly_there = 1 - 1e-4;
// Smallest distance from which a lamp is looked at, local units.
constexpr double nearest_place = 1e-5;

/// Returns a direction uniform by solid angle in a cone about `axis` (unit).
Vec3 direction_in_cone(Vec3 axis, double cosine, UnitPair at) {
  const Vec3 side = normalized(cross(axis, std::abs(axis.y) < 0.7 ? Vec3{0, 1, 0} : Vec3{0, 0, 1})), up = cross(axis, side);
  const double z = 1 - at.u * (1 - cosine), r = std::sqrt(std::max(0.0, 1 - z * z)), turn = 2 * std::numbers::pi * at.v;
  return z * axis + r * std::cos(turn) * side + r * std::sin(turn) * up;
}

}  // namespace

Lamps::Lamps(std::span<const Light> lights, const Extent& extent, std::span<const Vec3> surface_points) {
  const double inf = std::numeric_limits<double>::infinity();
  low_ = {inf, inf, inf}, high_ = {-inf, -inf, -inf};
  for (const Vec3& vertex : surface_points) {
    const Vec3 p = (vertex - extent.centre) / extent.longest_side;
    low_ = lower(low_, p);
    high_ = upper(high_, p);
  }
  for (Light lamp : lights) {
    const bool is_round_about = lamp.kind == LightKind::sky || lamp.kind == LightKind::environment;
    if (lamp.intensity.is_zero() || is_round_about) continue;
    lamp.position = (lamp.position - extent.centre) / extent.longest_side;
    lamp.radius /= extent.longest_side;
    for (double* size : {&lamp.opening.across, &lamp.opening.along, &lamp.opening.height}) *size /= extent.longest_side;
    if (lamp.opening.shape == LuminousOpening::Shape::sphere) lamp.radius = lamp.opening.across / 2;
    Opening& opening = openings_.emplace_back();
    if (lamp.kind == LightKind::luminaire) {
      opening.faces = faces_of_opening(lamp), opening.greatest = lamp.web->greatest();
      opening.web.emplace(lamp);
    }
    for (const OpeningFace& face : opening.faces) opening.area += face.area;
    if (!lamp.is_distant()) lamp.intensity *= 1 / (extent.longest_side * extent.longest_side);
    lamps_.push_back(lamp);
  }
}

double Lamps::share_of_intensity(std::size_t which, Vec3 direction) const {
  const Light& lamp = lamps_[which];
  if (lamp.kind == LightKind::spot) return SpotCone(lamp).share(dot(direction, lamp.direction));
  return openings_[which].web ? openings_[which].web->intensity(direction) : 1;
}

// A sphere that is partly below the horizon brings light although its middle does not: its top counts here.
Rgb Lamps::unblocked(std::size_t which, Vec3 point, Vec3 normal) const {
  const Light& lamp = lamps_[which];
  if (lamp.is_distant()) {
    const double cosine = dot(normal, -lamp.direction) + std::sin(lamp.angular_diameter / 2);
    return std::max(0.0, cosine) * lamp.intensity;
  }
  const Vec3 way = lamp.position - point;
  const double radius = std::max(lamp.radius, radius_of(lamp)), distance = std::max({length(way), radius, nearest_place});
  const double height = dot(way, normal) + radius;
  if (height <= 0) return {};
  // Parts of an opening are seen from other directions than its middle: some light is expected from everywhere.
  const double least = lamp.kind == LightKind::luminaire ? 0.05 * openings_[which].greatest : 0;
  const double share = std::max(least, share_of_intensity(which, -way / std::max(length(way), nearest_place)));
  return share * std::min(1.0, height / distance) / (distance * distance) * lamp.intensity;
}

std::optional<Lamps::Sample> Lamps::sample(Vec3 point, Vec3 normal, double choice, UnitPair at) const {
  double all = 0;
  for (std::size_t lamp = 0; lamp < lamps_.size(); ++lamp) all += unblocked(lamp, point, normal).sum();
  if (all <= 0) return std::nullopt;
  double left = choice * all, share = 0;
  std::size_t chosen = 0;
  for (std::size_t lamp = 0; lamp < lamps_.size(); ++lamp) {
    const double brings = unblocked(lamp, point, normal).sum();
    if (brings <= 0) continue;
    chosen = lamp, share = brings / all;
    if (left < brings) break;
    left -= brings;
  }
  Sample sample = sample_of(chosen, point, normal, at);
  sample.irradiance *= 1 / share;
  if (sample.irradiance.is_zero()) return std::nullopt;
  return sample;
}

Lamps::Sample Lamps::sample_of(std::size_t which, Vec3 point, Vec3 normal, UnitPair at) const {
  const Light& lamp = lamps_[which];
  if (lamp.is_distant()) {
    const Vec3 direction =
        lamp.angular_diameter > 0 ? direction_in_cone(-lamp.direction, std::cos(lamp.angular_diameter / 2), at) : -lamp.direction;
    const double out = way_out(point, direction);
    return {std::max(0.0, dot(normal, direction)) * lamp.intensity, (out + 0.01) * direction, out};
  }
  if (!openings_[which].faces.empty()) return sample_of_opening(which, point, normal, at);
  const Vec3 way = lamp.position - point;
  const double distance = std::max(length(way), nearest_place);
  const double share = share_of_intensity(which, -way / distance);
  if (lamp.radius == 0 || distance <= lamp.radius) {
    const double most = std::max(distance, lamp.radius);
    return {share * std::max(0.0, dot(way, normal) / distance) / (most * most) * lamp.intensity, nearly_there * way, distance};
  }
  const double sine = lamp.radius / distance, cosine = std::sqrt(1 - sine * sine);
  const Vec3 direction = direction_in_cone(way / distance, cosine, at);
  // Radiance I / (pi r2) times the solid angle of the cone, 2 pi (1 - cosine).
  const double scale = 2 * (1 - cosine) / (lamp.radius * lamp.radius) * share * std::max(0.0, dot(direction, normal));
  // The way ends in the sphere's middle plane: what lies in the sphere before that would hide it.
  return {scale * lamp.intensity, nearly_there * distance * direction, distance};
}

// A point of one of the faces, chosen by the share of the opening's area that it shows to the point; faces that look away show
// none. Then the light that the web tells for that direction comes from that point.
Lamps::Sample Lamps::sample_of_opening(std::size_t which, Vec3 point, Vec3 normal, UnitPair at) const {
  const Light& lamp = lamps_[which];
  const Opening& opening = openings_[which];
  const OpeningFace* face = opening.faces.data();
  double left = at.u * opening.area;
  while (left >= face->area && face != &opening.faces.back()) left -= face++->area;
  const Vec3 way = face->at({std::min(1.0, left / face->area), at.v}) - point;
  const double distance = std::max(length(way), nearest_place);
  const Vec3 out = -way / distance;
  double share = 1;
  if (opening.faces.size() > 1) {
    double shown = 0;
    for (const OpeningFace& other : opening.faces) shown += other.area * std::max(0.0, dot(other.normal, out));
    const double own = std::max(0.0, dot(face->normal, out));
    share = own > 0 ? opening.area * own / shown : 0;
  }
  const double scale = share * share_of_intensity(which, out) * std::max(0.0, -dot(out, normal)) / (distance * distance);
  return {scale * lamp.intensity, nearly_there * way, distance};
}

double Lamps::way_out(Vec3 point, Vec3 direction) const {
  double out = std::numeric_limits<double>::infinity();
  const auto leave = [&](double at, double step, double low, double high) {
    if (step != 0) out = std::min(out, ((step > 0 ? high : low) - at) / step);
  };
  leave(point.x, direction.x, low_.x, high_.x);
  leave(point.y, direction.y, low_.y, high_.y);
  leave(point.z, direction.z, low_.z, high_.z);
  return std::max(0.0, out);
}

}  // namespace alvor
