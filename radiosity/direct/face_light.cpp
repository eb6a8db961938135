#include "radiosity/direct/face_light.h"

#include "meshing/patch_reflectance.h"
#include "radiosity/form_factors/form_factor.h"

#include <algorithm>
#include <numbers>

namespace alvor {

FaceLight::FaceLight(const LocalScene& scene, std::uint32_t root, const RelativeLight& emission, double cover)
    : LightSource(root, emission, cover * emission.sum() * scene.mesh().roots()[root].area), scene_(scene) {}

double FaceLight::unblocked(Vec3 at, Vec3 normal) const {
  const auto corners = scene_.corners(root());
  return dot(at - corners[0], scene_.mesh().roots()[root()].normal) > 0 ? point_to_polygon(at, normal, corners) : 0;
}

void FaceLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  const LocalRoot& to = scene_.root(root());
  RayPacket& rays = aim.rays;
  for (std::size_t o = first; o < last; ++o) {
    const Uv target = on_face(to.is_quad ? 4 : 3, aim.at[o]);
    const auto u = static_cast<float>(target.u), v = static_cast<float>(target.v);
    const auto at = [&](float origin, float edge_u, float edge_v, float twist) {
      return origin + u * edge_u + v * edge_v + u * v * twist;
    };
    rays.origin_x[o] = aim.from.x[o], rays.origin_y[o] = aim.from.y[o], rays.origin_z[o] = aim.from.z[o];
    rays.direction_x[o] = at(to.origin.x, to.edge_u.x, to.edge_v.x, to.twist.x) - aim.from.x[o];
    rays.direction_y[o] = at(to.origin.y, to.edge_u.y, to.edge_v.y, to.twist.y) - aim.from.y[o];
    rays.direction_z[o] = at(to.origin.z, to.edge_u.z, to.edge_v.z, to.twist.z) - aim.from.z[o];
    rays.t_min[o] = 0;
    rays.t_max[o] = short_of_light;
    if (aim.there) (*aim.there)[o] = static_cast<float>(opacity_at(scene_.mesh(), root(), target));
  }
  const Float3 &n = aim.normal, &m = to.normal;
  for (std::size_t o = first; o < last; ++o) {
    const float x = rays.direction_x[o], y = rays.direction_y[o], z = rays.direction_z[o];
    const float squared = x * x + y * y + z * z;
    const float here = std::max(0.0f, x * n.x + y * n.y + z * n.z), there = std::max(0.0f, -(x * m.x + y * m.y + z * m.z));
    aim.weights[o] = here * there / (squared * squared + 1e-30f);
  }
}

double FaceLight::sample_scale(double probability) const {
  const double scale = scene_.frame().metres_per_unit, area = scene_.mesh().roots()[root()].area / (scale * scale);
  return area / (std::numbers::pi * probability);
}

std::optional<LightExtent> FaceLight::extent() const {
  const auto corners = scene_.corners(root());
  const double scale = scene_.frame().metres_per_unit;
  LightExtent extent{corners[0],    corners[0], corners[0], scene_.mesh().roots()[root()].normal, power() / (scale * scale),
                     colour().sum()};
  for (const Vec3 corner : corners) extent.low = lower(extent.low, corner), extent.high = upper(extent.high, corner);
  return extent;
}

std::span<const Vec3> FaceLight::polygon() const {
  if (scene_.mesh().material_of(root()).has_cutout()) return {};
  return scene_.corners(root());
}

}  // namespace alvor
