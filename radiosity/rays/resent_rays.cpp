#include "radiosity/rays/resent_rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace alvor {

namespace {

// As in transport_rows.cpp: a ray that slipped through a seam is sent in sixteen directions, 1 to 16 times this share of the
// normal apart.
constexpr double nudge = 1e-4;

/// Makes a hit from behind one of the face's other side. Returns whether the ray ended on a front.
bool turn_to_front(const LocalScene& scene, const RayPacket& rays, HitPacket& hits, int lane) {
  if (hits.root[lane] == HitPacket::nothing) return false;
  const LocalRoot& root = scene.root(hits.root[lane]);
  const float facing =
      rays.direction_x[lane] * root.normal.x + rays.direction_y[lane] * root.normal.y + rays.direction_z[lane] * root.normal.z;
  if (facing < 0) return true;
  if (root.twin == RootPatch::no_twin) return false;
  hits.root[lane] = root.twin;
  std::swap(hits.u[lane], hits.v[lane]);
  return true;
}

void trace(const LocalScene& scene, const RayPacket& rays, HitPacket& hits, std::uint64_t count, RayBudget& budget) {
  budget.spend(count, [&] { scene.visibility().closest_hits({&rays, 1}, {&hits, 1}); });
}

/// Sends one ray in sixteen directions that differ a little. Returns whether one of them ended on a front, and its hit in `lane`.
bool send_turned(const LocalScene& scene, const ResentRay& ray, Vec3 normal, RayBudget& budget, HitPacket& hits, int lane) {
  RayPacket again;
  HitPacket found;
  const Vec3 way = normalized(ray.towards - ray.from);
  for (std::size_t r = 0; r < RayPacket::width; ++r)
    again.set(r, ray.from, way + nudge * static_cast<double>(r + 1) * normal, std::numeric_limits<float>::infinity());
  trace(scene, again, found, RayPacket::width, budget);
  for (int r = 0; r < RayPacket::width; ++r) {
    if (!turn_to_front(scene, again, found, r)) continue;
    hits.root[lane] = found.root[r], hits.u[lane] = found.u[r], hits.v[lane] = found.v[r];
    return true;
  }
  return false;
}

}  // namespace

std::uint16_t meet_backs(const LocalScene& scene, std::uint32_t root, const PatchPoints& points, RayBudget& budget) {
  RayPacket packet;
  HitPacket hits;
  const LocalRoot& frame = scene.root(root);
  const auto as_vec3 = [](const Float3& v) { return Vec3{v.x, v.y, v.z}; };
  for (std::size_t o = 0; o < RayPacket::width; ++o) {
    const double angle = 2 * std::numbers::pi * std::numbers::phi * static_cast<double>(o);
    const double squared = (static_cast<double>(o) + 0.5) / RayPacket::width;  // of the distance from the disk's middle (Nusselt)
    const Vec3 way =
        std::sqrt(squared) * (std::cos(angle) * as_vec3(frame.tangent) + std::sin(angle) * as_vec3(frame.bitangent)) +
        std::sqrt(1 - squared) * as_vec3(frame.normal);
    packet.set(o, {points.x[o], points.y[o], points.z[o]}, way, std::numeric_limits<float>::infinity());
  }
  trace(scene, packet, hits, RayPacket::width, budget);
  std::uint16_t backs = 0;
  for (int o = 0; o < RayPacket::width; ++o)
    if (hits.root[o] != HitPacket::nothing && !turn_to_front(scene, packet, hits, o))
      backs |= static_cast<std::uint16_t>(1u << o);
  return backs;
}

std::vector<std::optional<PatchId>> resend(const LocalScene& scene, std::span<const ResentRay> rays, Vec3 normal,
                                           RayBudget& budget) {
  std::vector<std::optional<PatchId>> ends;
  for (std::size_t first = 0; first < rays.size(); first += RayPacket::width) {
    const auto part = rays.subspan(first, std::min<std::size_t>(RayPacket::width, rays.size() - first));
    RayPacket packet;
    HitPacket hits;
    for (std::size_t lane = 0; lane < RayPacket::width; ++lane) {
      const ResentRay& ray = part[std::min(lane, part.size() - 1)];
      packet.set(lane, ray.from, normalized(ray.towards - ray.from), std::numeric_limits<float>::infinity());
    }
    trace(scene, packet, hits, part.size(), budget);
    bool is_front[RayPacket::width];
    for (int lane = 0; lane < static_cast<int>(part.size()); ++lane) {
      const bool has_slipped = hits.root[lane] == HitPacket::nothing;
      is_front[lane] = has_slipped ? send_turned(scene, part[static_cast<std::size_t>(lane)], normal, budget, hits, lane)
                                   : turn_to_front(scene, packet, hits, lane);
    }
    alignas(64) std::uint32_t path[RayPacket::width];
    for (std::size_t lane = part.size(); lane < RayPacket::width; ++lane) hits.root[lane] = HitPacket::nothing;
    scene.places_of_hits(hits, path);
    for (std::size_t lane = 0; lane < part.size(); ++lane)
      ends.push_back(is_front[lane] ? std::optional(PatchId::finest(hits.root[lane], path[lane])) : std::nullopt);
  }
  return ends;
}

}  // namespace alvor
