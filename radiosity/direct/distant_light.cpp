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

/// Returns the area, m2, across which parallel light from `towards` meets fronts first; never 0.
double area_met(const LocalScene& scene, Vec3 towards) {
  std::vector<RayPacket> rays(trial_packets);
  std::vector<HitPacket> hits(trial_packets);
  for (std::uint32_t n = 0; n < trial_packets * RayPacket::width; ++n) {
    const Vec3 from = scene_radius * (towards + disk_point(towards, sobol_point(n, 0, 0)));
    RayPacket& packet = rays[n / RayPacket::width];
    const auto lane = n % RayPacket::width;
    packet.origin_x[lane] = static_cast<float>(from.x), packet.direction_x[lane] = static_cast<float>(-towards.x);
    packet.origin_y[lane] = static_cast<float>(from.y), packet.direction_y[lane] = static_cast<float>(-towards.y);
    packet.origin_z[lane] = static_cast<float>(from.z), packet.direction_z[lane] = static_cast<float>(-towards.z);
    packet.t_min[lane] = 0, packet.t_max[lane] = 4;
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

void DistantLight::aim(const ShadowAim& aim, int first, int last) const {
  const Vec3 normal{aim.normal.x, aim.normal.y, aim.normal.z};
  for (int o = first; o < last; ++o) {
    const Vec3 from{aim.from.x[o], aim.from.y[o], aim.from.z[o]};
    Vec3 direction = towards_;
    if (half_width_ > 0)
      direction = normalized(towards_ + half_width_ * disk_point(towards_, aim.at[static_cast<std::size_t>(o)]));
    const Vec3 way = box_.way_out(from, direction) * direction;
    set_ray(aim, o, way, 1);
    aim.weights[static_cast<std::size_t>(o)] = static_cast<float>(std::max(0.0, dot(direction, normal)));
  }
}

}  // namespace alvor
