#include "radiosity/direct/sky_exits.h"

#include "radiosity/direct/openings.h"
#include "radiosity/direct/scene_box.h"
#include "radiosity/rays/sampling.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace alvor {

namespace {

// Rays in all, spread evenly over the faces, and the least for each face. Chosen: 2^18 rays take a tenth of a second.
constexpr std::uint32_t rays_in_all = 1u << 18, least_packets_of_face = 1, most_packets_of_face = 2048;
// Share of its rays that leave the scene from which on a face looks for the sky in all directions: then few of its shadow rays
// are blocked. Chosen; not measured at half and double.
constexpr double open_share = 0.25;

/// Sends rays from one face: a direction each from points spread over it.
class FaceRays {
 public:
  FaceRays(const LocalScene& scene, std::uint32_t root, std::uint32_t packets) : rays_(packets), hits_(packets) {
    const LocalRoot& local = scene.root(root);
    const auto vec = [](Float3 v) { return Vec3{v.x, v.y, v.z}; };
    const Vec3 normal = vec(local.normal);
    const RootPatch& patch = scene.mesh().roots()[root];
    const auto scramble = static_cast<std::uint32_t>(mix_bits(root));
    for (std::uint32_t n = 0; n < packets * RayPacket::width; ++n) {
      const Uv at = on_face(patch.corner_count, sobol_point(n, scramble, scramble * 0x9e3779b9u));
      const Uv way = sobol_point(n, ~scramble, scramble * 0x85ebca6bu);
      const double radius = std::sqrt(way.u), angle = 2 * std::numbers::pi * way.v;
      const Vec3 direction = radius * std::cos(angle) * vec(local.tangent) + radius * std::sin(angle) * vec(local.bitangent) +
                             std::sqrt(1 - way.u) * normal;
      set(n, scene.frame().to_local(patch.at(at.u, at.v)) + off_surface * normal, direction);
    }
    scene.visibility().closest_hits(rays_, hits_);
  }

  std::size_t size() const { return sent_.size(); }
  const ProbeRay& operator[](std::size_t n) const { return sent_[n]; }
  bool left(std::size_t n) const { return hits_[n / RayPacket::width].root[n % RayPacket::width] == HitPacket::nothing; }

 private:
  // Height above the face at which rays start, local units: some roundings of float32.
  static constexpr double off_surface = 1e-6;
  // Length of a way that leads out of the scene from any place in it, local units.
  static constexpr float way_through = 4;

  void set(std::uint32_t n, Vec3 from, Vec3 direction) {
    rays_[n / RayPacket::width].set(n % RayPacket::width, from, direction, way_through);
    sent_.push_back({from, direction});
  }

  std::vector<RayPacket> rays_;
  std::vector<HitPacket> hits_;
  std::vector<ProbeRay> sent_;
};

}  // namespace

SkyExits::SkyExits(const LocalScene& scene, std::vector<WayOut>& ways_out) : is_open(scene.mesh().roots().size()) {
  const auto roots = static_cast<std::uint32_t>(is_open.size());
  const std::uint32_t packets =
      std::clamp(rays_in_all / RayPacket::width / std::max(1u, roots), least_packets_of_face, most_packets_of_face);
  // Many faces send more rays than are wanted: one of so many is looked at.
  const std::size_t stride = std::max<std::size_t>(1, std::size_t{roots} * packets * RayPacket::width / rays_in_all);
  const double metres = scene.frame().metres_per_unit;
  ProbeRays of_closed;
  for (std::uint32_t root = 0; root < roots; ++root) {
    const FaceRays rays(scene, root, packets);
    std::size_t left = 0;
    for (std::size_t n = 0; n < rays.size(); ++n) left += rays.left(n);
    is_open[root] = static_cast<double>(left) > open_share * static_cast<double>(rays.size());
    any_open = any_open || is_open[root];
    const double area = scene.mesh().roots()[root].area / (metres * metres) / static_cast<double>(rays.size());
    for (std::size_t n = 0; n < rays.size(); ++n) {
      if (rays.left(n)) ways_out.push_back({rays[n].direction, area, is_open[root]});
      if (is_open[root]) continue;
      const std::size_t turn = root + n;
      if (rays.left(n) && turn % stride == 0) of_closed.left.push_back(rays[n]);
      if (!rays.left(n) && turn % (stride * ProbeRays::each_stayed) == 0) of_closed.stayed.push_back(rays[n]);
    }
  }
  exits = find_openings(scene, SceneBox(scene), of_closed);
}

}  // namespace alvor
