#include "radiosity/direct/lamp_light.h"

#include "radiosity/direct/disk_point.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

double squared(double x) { return x * x; }

double radius_of_sphere(const Light& lamp) { return lamp.kind == LightKind::luminaire ? lamp.opening.across / 2 : lamp.radius; }

}  // namespace

LampLight::LampLight(const LocalScene& scene, std::uint32_t number, const Light& lamp, const RelativeLight& colour, double power,
                     double greatest)
    : LightSource(number, colour, power),
      lamp_(lamp),
      cone_(lamp.kind == LightKind::spot ? std::optional(SpotCone(lamp)) : std::nullopt),
      web_(lamp.kind == LightKind::luminaire ? std::optional(HungWeb(lamp)) : std::nullopt),
      place_(scene.frame().to_local(lamp.position)),
      radius_(radius_of_sphere(lamp) / scene.frame().metres_per_unit),
      nearest_(std::max(radius_, nearest_look)),
      greatest_(greatest) {}

/// Returns the lamp's intensity in a direction (unit), in multiples of its own.
double LampLight::share(Vec3 direction) const {
  if (cone_) return cone_->share(dot(direction, lamp_.direction));
  return web_ ? web_->intensity(direction) : 1;
}

double LampLight::share_over_distance_squared(Vec3 from_lamp, double distance_squared) const {
  return share(from_lamp / std::sqrt(distance_squared)) / std::max(distance_squared, nearest_ * nearest_);
}

double LampLight::unblocked(Vec3 at, Vec3 normal) const {
  const Vec3 way = place_ - at;
  const double height = dot(way, normal), distance_squared = dot(way, way);
  if (height <= 0) return 0;
  return height / std::sqrt(distance_squared) * share_over_distance_squared(-way, distance_squared);
}

void LampLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  for (std::size_t o = first; o < last; ++o) {
    const Vec3 way = place_ - aim.start(o);
    const double distance_squared = std::max(dot(way, way), 1e-30), distance = std::sqrt(distance_squared);
    Vec3 target = way;
    if (radius_ > 0) {
      // The disk is as wide as the cone in which the sphere is seen.
      const double sine = std::min(0.99, radius_ / distance), edge = distance * sine / std::sqrt(1 - sine * sine);
      target += edge * disk_point(TangentFrame(way / distance), aim.at[o]);
    }
    const double cosine = std::max(0.0, dot(target, aim.facing()) / distance);
    aim.set(o, target, short_of_light, cosine * share_over_distance_squared(-way, distance_squared));
  }
}

std::optional<LightExtent> LampLight::extent() const {
  const Vec3 around{radius_, radius_, radius_};
  const double intensity = colour().sum() * greatest_;
  return LightExtent{place_, place_ - around, place_ + around, {}, std::numbers::pi * intensity, intensity / squared(nearest_)};
}

}  // namespace alvor
