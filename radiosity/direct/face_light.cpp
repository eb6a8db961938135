#include "radiosity/direct/face_light.h"

#include "meshing/patch_reflectance.h"
#include "radiosity/form_factors/form_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

// Share of a light's longer edge. A light farther off is aimed at evenly: its parts bring about the same. Chosen.
constexpr float near_share = 0.5f;

Float3 minus(const Float3& a, const Float3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
float dot(const Float3& a, const Float3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Chooses places along the longer edge of a near quad as they are spread evenly over angles from a point, because near ones
/// bring most (equiangular sampling: Kulla & Fajardo 2012).
class EvenInAngle {
 public:
  EvenInAngle(const LocalRoot& light, const Float3& from) {
    const float along_u = dot(light.edge_u, light.edge_u), along_v = dot(light.edge_v, light.edge_v);
    is_along_u_ = along_u >= along_v;
    const Float3& along = is_along_u_ ? light.edge_u : light.edge_v;
    const Float3& across = is_along_u_ ? light.edge_v : light.edge_u;
    const float squared = std::max(along_u, along_v);
    const Float3 way{from.x - light.origin.x - across.x / 2, from.y - light.origin.y - across.y / 2,
                     from.z - light.origin.z - across.z / 2};
    foot_ = dot(way, along) / squared;
    const Float3 off = minus(way, {foot_ * along.x, foot_ * along.y, foot_ * along.z});
    const float beyond = std::max({0.0f, -foot_, foot_ - 1});
    distance_ = std::sqrt(dot(off, off) / squared);
    is_near_ = light.is_quad && distance_ > 0 && std::hypot(distance_, beyond) < near_share;
    if (!is_near_) return;
    first_ = std::atan(-foot_ / distance_);
    range_ = std::atan((1 - foot_) / distance_) - first_;
  }

  /// Moves a place that is uniform in the unit square. Returns the inverse of the density there.
  float move(Uv& at) const {
    if (!is_near_) return 1;
    double& place = is_along_u_ ? at.u : at.v;
    const float tangent = std::tan(first_ + static_cast<float>(place) * range_);
    place = std::clamp(foot_ + distance_ * tangent, 0.0f, 1.0f);
    return range_ * distance_ * (1 + tangent * tangent);
  }

 private:
  bool is_along_u_, is_near_;
  float foot_, distance_;  // of the point from the quad's middle line, in lengths of that line
  float first_ = 0, range_ = 0;
};

}  // namespace

bool is_before(Vec3 at, std::span<const Vec3> face, Vec3 normal) {
  // Heights, in edges, up to which a point lies in the plane of a triangle but for rounding, and of a quad, which may be bent by
  // 4e-6 (meshing/polygon.h); and in lengths of the scene, whose coordinates are rounded, too.
  constexpr double of_triangle = 1e-9, of_quad = 4e-6, of_scene = 1e-12;
  const double height = dot(at - face[0], normal), in_plane = face.size() == 4 ? of_quad : of_triangle;
  if (height <= of_scene) return false;
  const Vec3 along = face[1] - face[0], other = face.back() - face[0];
  return height * height > in_plane * in_plane * (dot(along, along) + dot(other, other));
}

FaceLight::FaceLight(const LocalScene& scene, std::uint32_t root, const RelativeLight& emission, double cover)
    : LightSource(root, emission, cover * emission.sum() * scene.mesh().roots()[root].area), scene_(scene) {}

double FaceLight::unblocked(Vec3 at, Vec3 normal) const {
  const auto corners = scene_.corners(root());
  return is_before(at, corners, scene_.mesh().roots()[root()].normal) ? point_to_polygon(at, normal, corners) : 0;
}

void FaceLight::aim(const ShadowAim& aim, std::size_t first, std::size_t last) const {
  const LocalRoot& to = scene_.root(root());
  RayPacket& rays = aim.rays;
  std::array<float, RayPacket::width> share;
  for (std::size_t o = first; o < last; ++o) {
    Uv target = on_face(to.is_quad ? 4 : 3, aim.at[o]);
    share[o] = EvenInAngle(to, {aim.from.x[o], aim.from.y[o], aim.from.z[o]}).move(target);
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
    aim.weights[o] = share[o] * here * there / (squared * squared + 1e-30f);
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
