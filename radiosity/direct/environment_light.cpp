#include "radiosity/direct/environment_light.h"

#include "radiosity/direct/disk_point.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace alvor {

namespace {

// Steps of the table over normals: 1.9 degrees, so that a small bright part of the map is right within 1 % of its light.
constexpr int tilts = 96, turns = 192;
// Share of the shadow rays that are cosine-distributed.
constexpr double by_cosine = 0.5;

}  // namespace

EnvironmentLight::EnvironmentLight(const LocalScene& scene, std::uint32_t number, std::shared_ptr<const EnvironmentBand> band,
                                   const RelativeLight& colour, double power, std::shared_ptr<const SkyExits> exits)
    : LightSource(number, colour, power),
      band_(std::move(band)),
      exits_(std::move(exits)),
      box_(scene),
      irradiance_(band_->up(), tilts, turns, [&](Vec3 normal) { return band_->irradiance(normal); }) {}

void EnvironmentLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  const Vec3 normal = aim.facing();
  const TangentFrame tangents(normal);
  for (std::size_t o = first; o < last; ++o) {
    const Uv at = aim.at[o];
    Vec3 direction;
    if (at.u < by_cosine) {
      const double u = at.u / by_cosine;
      direction = normalized(disk_point(tangents, {u, at.v}) + std::sqrt(std::max(0.0, 1 - u)) * normal);
    } else {
      direction = band_->drawn((at.u - by_cosine) / (1 - by_cosine), at.v);
    }
    const double cosine = std::max(0.0, dot(direction, normal)), radiance = band_->radiance(direction);
    const double density = by_cosine * cosine / std::numbers::pi + (1 - by_cosine) * radiance;
    const double weight = density > 0 ? radiance * cosine / density : 0;
    aim.set(o, box_.way_out(aim.start(o), direction) * direction, 1, weight);
  }
}

}  // namespace alvor
