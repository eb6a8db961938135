#include "radiosity/direct/distant_light.h"

#include "radiosity/direct/disk_point.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace alvor {

namespace {

// Packets of rays that estimate how much of a distant light meets fronts. The estimate orders lights and the shown progress only.
constexpr std::uint32_t trial_packets = 256;
// Radius of a sphere about the local origin that holds the scene: half the diagonal of the unit cube, rounded up.
constexpr double scene_radius = 0.867;
// Length of a way that begins outside of the scene and leads through all of it, local units.
constexpr float way_through = 4;

/// Returns the area, m2, across which parallel light from `towards` meets fronts first; never 0.
double area_met(const LocalScene& scene, Vec3 towards) {
  std::vector<RayPacket> rays(trial_packets);
  std::vector<HitPacket> hits(trial_packets);
  const TangentFrame across(towards);
  for (std::uint32_t n = 0; n < trial_packets * RayPacket::width; ++n) {
    const Vec3 from = scene_radius * (towards + disk_point(across, sobol_point(n, 0, 0)));
    rays[n / RayPacket::width].set(n % RayPacket::width, from, -towards, way_through);
  }
  scene.visibility().closest_hits(rays, hits);
  double fronts = 0.5;
  for (const HitPacket& packet : hits)
    for (const std::uint32_t root : packet.root)
      fronts += root != HitPacket::nothing && dot(scene.mesh().roots()[root].normal, towards) > 0;
  const double radius = scene_radius * scene.frame().metres_per_unit;
  return std::numbers::pi * radius * radius * fronts / (trial_packets * RayPacket::width);
}

}  // namespace

DistantLight::DistantLight(const LocalScene& scene, std::uint32_t number, const Light& light, const RelativeLight& colour)
    : LightSource(number, colour, colour.sum() * area_met(scene, -light.direction)),
      towards_(-light.direction),
      half_width_(std::tan(light.angular_diameter / 2)),
      box_(scene) {}

double DistantLight::unblocked(Vec3, Vec3 normal) const { return std::max(0.0, dot(towards_, normal)); }

void DistantLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  const Vec3 normal = aim.facing();
  const TangentFrame across(towards_);
  for (std::size_t o = first; o < last; ++o) {
    Vec3 direction = towards_;
    if (half_width_ > 0) direction = normalized(towards_ + half_width_ * disk_point(across, aim.at[o]));
    aim.set(o, box_.way_out(aim.start(o), direction) * direction, 1, std::max(0.0, dot(direction, normal)));
  }
}

}  // namespace alvor
