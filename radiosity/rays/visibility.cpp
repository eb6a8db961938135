#include "radiosity/rays/visibility.h"

#include "radiosity/rays/cutouts.h"
#include "radiosity/rays/embree_scene.h"

#include <algorithm>
#include <cstring>
#include <tuple>
#include <type_traits>
#include <vector>

namespace alvor {

namespace {

void copy_rays(const RayPacket& from, RTCRay16& to) {
  constexpr std::size_t bytes = sizeof(float) * RayPacket::width;
  std::memcpy(to.org_x, from.origin_x, bytes);
  std::memcpy(to.org_y, from.origin_y, bytes);
  std::memcpy(to.org_z, from.origin_z, bytes);
  std::memcpy(to.dir_x, from.direction_x, bytes);
  std::memcpy(to.dir_y, from.direction_y, bytes);
  std::memcpy(to.dir_z, from.direction_z, bytes);
  std::memcpy(to.tnear, from.t_min, bytes);
  std::memcpy(to.tfar, from.t_max, bytes);
  std::memset(to.time, 0, bytes);
  std::memset(to.mask, 0xff, bytes);
  std::memset(to.flags, 0, bytes);
}

/// Numbers the rays of a packet by their lanes: Embree calls filters with rays in any order.
void number_rays(RTCRay16& rays) {
  for (unsigned lane = 0; lane < RayPacket::width; ++lane) rays.id[lane] = lane;
}

alignas(64) constexpr int all_lanes[RayPacket::width] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

}  // namespace

struct Visibility::Handles {
  explicit Handles(const BaseMesh& mesh) : cutouts(mesh) {}

  // Panes that the rays of a packet cross, beyond which panes end rays: memory must not grow with what a scene piles up.
  static constexpr std::size_t most_crossings = 16 * RayPacket::width * 256;
  /// Numbers of Embree's geometries: faces of four and of three corners, then the panes among them.
  static constexpr unsigned quads = 0, triangles = 1, panes = 2;
  EmbreeScene scene;
  std::vector<std::uint32_t> root_of[4];  // root patch of each primitive, by geometry
  std::vector<RgbF> transmittance_of[4];  // of each primitive of panes, by geometry
  const Cutouts cutouts;

  /// Returns the share of the surface that is there where a ray hits a pane.
  float opacity_at(const RTCHit& hit) const { return cutouts.opacity(root_of[hit.geomID][hit.primID], hit.u, hit.v); }
  /// Returns whether a ray ends where it hits a pane: something is there, and lets no light through.
  bool ends_ray(const RTCHit& hit, float opacity) const {
    return opacity == 1 && transmittance_of[hit.geomID][hit.primID] == RgbF{};
  }
  static void cross(const RTCFilterFunctionNArguments* arguments);
  static void dim(const RTCFilterFunctionNArguments* arguments);
};

namespace {

/// The places that the filters of panes, cross() and dim(), write to while one packet is traced. Embree gives filters a pointer
/// to `context`; because that is the first member, they cast it to PacketContext.
struct PacketContext {
  RTCIntersectContext context = incoherent_context();
  std::vector<Crossing>* crossings = nullptr;
  Visibility::Tints* tints = nullptr;
};
static_assert(std::is_standard_layout_v<PacketContext>);

}  // namespace

/// Lets rays go on through panes, and remembers where they crossed them. Embree calls it in any order along a ray.
void Visibility::Handles::cross(const RTCFilterFunctionNArguments* arguments) {
  const auto& handles = *static_cast<const Handles*>(arguments->geometryUserPtr);
  auto* const crossings = reinterpret_cast<PacketContext*>(arguments->context)->crossings;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0 || (crossings && crossings->size() >= most_crossings)) continue;
    const RTCHit hit = rtcGetHitFromHitN(arguments->hit, arguments->N, i);
    const float opacity = handles.opacity_at(hit);
    if (handles.ends_ray(hit, opacity)) continue;
    arguments->valid[i] = 0;
    if (!crossings || opacity == 0) continue;
    const RTCRay ray = rtcGetRayFromRayN(arguments->ray, arguments->N, i);
    crossings->push_back({ray.id, handles.root_of[hit.geomID][hit.primID], hit.u, hit.v, ray.tfar, opacity});
  }
}

/// Lets shadow rays go on through panes, and dims them.
void Visibility::Handles::dim(const RTCFilterFunctionNArguments* arguments) {
  const auto& handles = *static_cast<const Handles*>(arguments->geometryUserPtr);
  auto* const tints = reinterpret_cast<PacketContext*>(arguments->context)->tints;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const RTCHit hit = rtcGetHitFromHitN(arguments->hit, arguments->N, i);
    const float opacity = handles.opacity_at(hit);
    if (handles.ends_ray(hit, opacity)) continue;
    arguments->valid[i] = 0;
    if (!tints) continue;
    RgbF& tint = (*tints)[RTCRayN_id(arguments->ray, arguments->N, i)];
    tint = tint * straight_through(handles.transmittance_of[hit.geomID][hit.primID], opacity);
  }
}

Visibility::Visibility(const BaseMesh& mesh, const LocalFrame& frame) : handles_(std::make_unique<Handles>(mesh)) {
  const std::span<const RootPatch> roots = mesh.roots();
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 4>> quads[2];
  std::vector<std::array<std::uint32_t, 3>> triangles[2];
  for (std::uint32_t root = 0; root < roots.size(); ++root) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const int corners = roots[root].corner_count;
    if (roots[root].is_behind) continue;
    for (int c = 0; c < corners; ++c) vertices.push_back(to_float(frame.to_local(roots[root].corners[c])));
    const Material& material = mesh.material_of(root);
    const bool is_pane = material.is_pane();
    const unsigned geometry = (corners == 4 ? Handles::quads : Handles::triangles) + (is_pane ? Handles::panes : 0);
    handles_->root_of[geometry].push_back(root);
    if (is_pane) handles_->transmittance_of[geometry].push_back(narrow(material.regular_transmittance));
    if (corners == 4) quads[is_pane].push_back({first, first + 1, first + 2, first + 3});
    else triangles[is_pane].push_back({first, first + 1, first + 2});
  }
  handles_->scene.add<4>(Handles::quads, vertices, quads[0]);
  handles_->scene.add<3>(Handles::triangles, vertices, triangles[0]);
  handles_->scene.add<4>(Handles::panes + Handles::quads, vertices, quads[1], Handles::cross, Handles::dim, handles_.get());
  handles_->scene.add<3>(Handles::panes + Handles::triangles, vertices, triangles[1], Handles::cross, Handles::dim,
                         handles_.get());
  handles_->scene.commit();
}

Visibility::~Visibility() = default;
Visibility::Visibility(Visibility&&) noexcept = default;
Visibility& Visibility::operator=(Visibility&&) noexcept = default;

namespace {

/// Leaves the crossings before each ray's hit, each face once, ordered by lane and then along the ray.
void put_in_order(std::vector<Crossing>& crossings, const HitPacket& hit) {
  std::erase_if(crossings, [&](const Crossing& crossing) { return crossing.t > hit.t[crossing.lane]; });
  std::ranges::sort(crossings, [](const Crossing& a, const Crossing& b) {
    return std::tie(a.lane, a.t, a.root) < std::tie(b.lane, b.t, b.root);
  });
  // Embree may report both halves of a quad on their common edge.
  const auto is_same = [](const Crossing& a, const Crossing& b) { return a.lane == b.lane && a.root == b.root; };
  crossings.erase(std::unique(crossings.begin(), crossings.end(), is_same), crossings.end());
}

}  // namespace

void Visibility::closest_hits(std::span<const RayPacket> packets, std::span<HitPacket> hits,
                              std::span<std::vector<Crossing>> crossings) const {
  const FlushDenormals flush;
  PacketContext context;
  alignas(64) RTCRayHit16 query;
  number_rays(query.ray);
  for (std::size_t p = 0; p < packets.size(); ++p) {
    copy_rays(packets[p], query.ray);
    std::memset(query.hit.geomID, 0xff, sizeof query.hit.geomID);
    std::memset(query.hit.instID, 0xff, sizeof query.hit.instID);
    if (!crossings.empty()) context.crossings = &crossings[p], context.crossings->clear();
    rtcIntersect16(all_lanes, handles_->scene.get(), &context.context, &query);
    HitPacket& hit = hits[p];
    for (int lane = 0; lane < RayPacket::width; ++lane) {
      const unsigned geometry = query.hit.geomID[lane];
      hit.root[lane] =
          geometry == RTC_INVALID_GEOMETRY_ID ? HitPacket::nothing : handles_->root_of[geometry][query.hit.primID[lane]];
    }
    std::memcpy(hit.u, query.hit.u, sizeof hit.u);
    std::memcpy(hit.v, query.hit.v, sizeof hit.v);
    std::memcpy(hit.t, query.ray.tfar, sizeof hit.t);
    if (context.crossings && !context.crossings->empty()) put_in_order(*context.crossings, hit);
  }
}

void Visibility::occlusions(std::span<const RayPacket> packets, std::span<std::uint16_t> blocked, std::span<Tints> tints) const {
  const FlushDenormals flush;
  PacketContext context;
  alignas(64) RTCRay16 query;
  number_rays(query);
  for (std::size_t p = 0; p < packets.size(); ++p) {
    copy_rays(packets[p], query);
    if (!tints.empty()) context.tints = &tints[p], context.tints->fill({1, 1, 1});
    rtcOccluded16(all_lanes, handles_->scene.get(), &context.context, &query);
    std::uint16_t mask = 0;
    for (int lane = 0; lane < RayPacket::width; ++lane)
      mask |= static_cast<std::uint16_t>((query.tfar[lane] < 0) << lane);  // Embree sets -inf where blocked
    blocked[p] = mask;
  }
}

}  // namespace alvor
