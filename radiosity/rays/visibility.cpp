#include "radiosity/rays/visibility.h"

#include <embree3/rtcore.h>
#include <pmmintrin.h>
#include <xmmintrin.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <type_traits>
#include <vector>

namespace alvor {

namespace {

/// Makes the processor treat denormal numbers as zero, because they slow traversal down; restores the caller's mode at the end.
class FlushDenormals {
 public:
  FlushDenormals() : before_(_mm_getcsr()) { _mm_setcsr(before_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON); }
  ~FlushDenormals() { _mm_setcsr(before_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  unsigned before_;
};

/// An Embree device and a scene of it, released together.
class EmbreeScene {
 public:
  explicit EmbreeScene(RTCSceneFlags flags = RTC_SCENE_FLAG_NONE) : device_(rtcNewDevice(nullptr)) {
    if (!device_) throw std::runtime_error("Embree: no device");
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags);
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  /// Adds polygons of N corners each under the geometry id `id`.
  /// `filter` is called for the hits of rays on them, with `owner` as its geometryUserPtr, and for occlusions `occlusion_filter`.
  template <std::size_t N>
  void add(unsigned id, std::span<const std::array<float, 3>> vertices, std::span<const std::array<std::uint32_t, N>> polygons,
           RTCFilterFunctionN filter = nullptr, RTCFilterFunctionN occlusion_filter = nullptr, void* owner = nullptr) {
    if (polygons.empty()) return;
    const auto type = N == 4 ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE;
    RTCGeometry geometry = rtcNewGeometry(device_, type);
    copy_to(geometry, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3, vertices);
    copy_to(geometry, RTC_BUFFER_TYPE_INDEX, N == 4 ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3, polygons);
    rtcSetGeometryIntersectFilterFunction(geometry, filter);
    rtcSetGeometryOccludedFilterFunction(geometry, occlusion_filter);
    rtcSetGeometryUserData(geometry, owner);
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, id);
    rtcReleaseGeometry(geometry);
  }
  void commit() {
    rtcCommitScene(scene_);
    if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree: the scene could not be built");
  }
  RTCScene get() const { return scene_; }

 private:
  template <class T>
  void copy_to(RTCGeometry geometry, RTCBufferType buffer, RTCFormat format, std::span<const T> items) {
    void* to = rtcSetNewGeometryBuffer(geometry, buffer, 0, format, sizeof(T), items.size());
    if (!to) throw std::runtime_error("Embree: out of memory");
    std::memcpy(to, items.data(), items.size_bytes());
  }

  RTCDevice device_;
  RTCScene scene_;
};

std::array<float, 3> to_float(Vec3 p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

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

RTCIntersectContext incoherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

}  // namespace

struct Visibility::Handles {
  // Panes that the rays of a packet cross, beyond which panes end rays: memory must not grow with what a scene piles up.
  static constexpr std::size_t most_crossings = 16 * RayPacket::width * 256;
  /// Numbers of Embree's geometries: faces of four and of three corners, then the panes among them.
  static constexpr unsigned quads = 0, triangles = 1, panes = 2;
  EmbreeScene scene;
  std::vector<std::uint32_t> root_of[4];  // root patch of each primitive, by geometry
  std::vector<RgbF> transmittance_of[4];  // of each primitive of panes, by geometry

  static void cross(const RTCFilterFunctionNArguments* arguments);
  static void dim(const RTCFilterFunctionNArguments* arguments);
};

namespace {

/// What filters write to while a packet is traced. Embree hands them a pointer to its own part, the first.
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
    arguments->valid[i] = 0;
    if (!crossings) continue;
    const RTCRay ray = rtcGetRayFromRayN(arguments->ray, arguments->N, i);
    const RTCHit hit = rtcGetHitFromHitN(arguments->hit, arguments->N, i);
    crossings->push_back({ray.id, handles.root_of[hit.geomID][hit.primID], hit.u, hit.v, ray.tfar});
  }
}

/// Lets shadow rays go on through panes, and dims them.
void Visibility::Handles::dim(const RTCFilterFunctionNArguments* arguments) {
  const auto& handles = *static_cast<const Handles*>(arguments->geometryUserPtr);
  auto* const tints = reinterpret_cast<PacketContext*>(arguments->context)->tints;
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    arguments->valid[i] = 0;
    if (!tints) continue;
    const RTCHit hit = rtcGetHitFromHitN(arguments->hit, arguments->N, i);
    RgbF& tint = (*tints)[RTCRayN_id(arguments->ray, arguments->N, i)];
    tint = tint * handles.transmittance_of[hit.geomID][hit.primID];
  }
}

Visibility::Visibility(std::span<const RootPatch> roots, std::span<const Material> materials, const LocalFrame& frame)
    : handles_(std::make_unique<Handles>()) {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 4>> quads[2];
  std::vector<std::array<std::uint32_t, 3>> triangles[2];
  for (std::uint32_t root = 0; root < roots.size(); ++root) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    const int corners = roots[root].corner_count;
    if (roots[root].is_behind) continue;
    for (int c = 0; c < corners; ++c) vertices.push_back(to_float(frame.to_local(roots[root].corners[c])));
    const Material& material = materials[roots[root].material];
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

struct TriangleCaster::Handles {
  explicit Handles(Traversal traversal)
      : scene(static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION |
                                         (traversal == Traversal::watertight ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE))) {}

  EmbreeScene scene;
  std::vector<Vec3> positions;  // relative to `centre`
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Vec3 centre;
};

namespace {

struct ClosestPoint {
  double u, v, squared_distance;
};

/// Returns the point of triangle (a, b, c) closest to p, by the regions of its barycentric plane (Ericson, Real-Time Collision
/// Detection, 5.1.5).
ClosestPoint closest_point(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 ab = b - a, ac = c - a;
  const auto at = [&](double u, double v) {
    const Vec3 d = a + u * ab + v * ac - p;
    return ClosestPoint{u, v, dot(d, d)};
  };
  const double d1 = dot(ab, p - a), d2 = dot(ac, p - a);
  if (d1 <= 0 && d2 <= 0) return at(0, 0);
  const double d3 = dot(ab, p - b), d4 = dot(ac, p - b);
  if (d3 >= 0 && d4 <= d3) return at(1, 0);
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
  const double d5 = dot(ab, p - c), d6 = dot(ac, p - c);
  if (d6 >= 0 && d5 <= d6) return at(0, 1);
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return at(1 - w, w);
  }
  const double denominator = 1 / (va + vb + vc);
  return at(vb * denominator, vc * denominator);
}

struct NearestSearch {
  std::span<const Vec3> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  Vec3 point, normal;
  std::optional<TriangleCaster::Hit> best;
};

bool visit_triangle(RTCPointQueryFunctionArguments* arguments) {
  auto& search = *static_cast<NearestSearch*>(arguments->userPtr);
  const auto& triangle = search.triangles[arguments->primID];
  const Vec3 a = search.positions[triangle[0]], b = search.positions[triangle[1]], c = search.positions[triangle[2]];
  const Vec3 n = cross(b - a, c - a);
  constexpr double cosine_60 = 0.5;
  if (dot(n, search.normal) < cosine_60 * length(n)) return false;
  const ClosestPoint near = closest_point(search.point, a, b, c);
  const double distance = std::sqrt(near.squared_distance);
  if (search.best && distance >= search.best->distance) return false;
  search.best = TriangleCaster::Hit{arguments->primID, near.u, near.v, distance};
  // The new search radius is slightly more than the distance, because Embree's bounds are float32.
  arguments->query->radius = std::nextafter(static_cast<float>(distance * (1 + 1e-6)), std::numeric_limits<float>::infinity());
  return true;
}

/// What the filters of one ray know. Embree hands them a pointer to its own part, the first.
struct CastContext {
  RTCIntersectContext context = incoherent_context();
  std::span<const std::uint32_t> passed;
};
static_assert(std::is_standard_layout_v<CastContext>);

/// Rejects the hits on triangles that the ray has passed, and if `fronts_only` those that meet the back of a triangle.
template <bool fronts_only>
void pass(const RTCFilterFunctionNArguments* arguments) {
  const auto& passed = reinterpret_cast<const CastContext*>(arguments->context)->passed;
  for (unsigned i = 0; i < arguments->N; ++i) {
    const RTCRay ray = rtcGetRayFromRayN(arguments->ray, arguments->N, i);
    const RTCHit hit = rtcGetHitFromHitN(arguments->hit, arguments->N, i);
    const bool is_back = ray.dir_x * hit.Ng_x + ray.dir_y * hit.Ng_y + ray.dir_z * hit.Ng_z >= 0;
    if ((fronts_only && is_back) || std::ranges::find(passed, hit.primID) != passed.end()) arguments->valid[i] = 0;
  }
}

RTCRay ray_along(Vec3 origin, Vec3 direction, float t_max) {
  const auto from = to_float(origin), along = to_float(direction);
  RTCRay ray{};
  ray.org_x = from[0], ray.org_y = from[1], ray.org_z = from[2];
  ray.dir_x = along[0], ray.dir_y = along[1], ray.dir_z = along[2];
  ray.tfar = t_max;
  ray.mask = ~0u;
  return ray;
}

Vec3 centre_of(std::span<const Vec3> positions) {
  if (positions.empty()) return {};
  Vec3 low = positions[0], high = low;
  for (const Vec3& p : positions) {
    low = lower(low, p);
    high = upper(high, p);
  }
  return lerp(low, high, 0.5);
}

}  // namespace

TriangleCaster::TriangleCaster(std::span<const Vec3> positions, std::span<const std::array<std::uint32_t, 3>> triangles,
                               Traversal traversal)
    : handles_(std::make_unique<Handles>(traversal)) {
  handles_->centre = centre_of(positions);
  std::vector<std::array<float, 3>> vertices;
  for (const Vec3& p : positions) {
    handles_->positions.push_back(p - handles_->centre);
    vertices.push_back(to_float(handles_->positions.back()));
  }
  handles_->triangles.assign(triangles.begin(), triangles.end());
  handles_->scene.add<3>(0, vertices, triangles);
  handles_->scene.commit();
}

TriangleCaster::~TriangleCaster() = default;

namespace {

std::optional<TriangleCaster::Hit> closest_hit(RTCScene scene, Vec3 origin, Vec3 direction, std::span<const std::uint32_t> passed,
                                               RTCFilterFunctionN filter) {
  const FlushDenormals flush;
  CastContext context;
  context.context.filter = filter;
  context.passed = passed;
  RTCRayHit query;
  query.ray = ray_along(origin, direction, std::numeric_limits<float>::infinity());
  query.hit.geomID = query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context.context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  return TriangleCaster::Hit{query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
}

}  // namespace

std::optional<TriangleCaster::Hit> TriangleCaster::cast(Vec3 origin, Vec3 direction,
                                                        std::span<const std::uint32_t> passed) const {
  return closest_hit(handles_->scene.get(), origin - handles_->centre, direction, passed, passed.empty() ? nullptr : pass<false>);
}

std::optional<TriangleCaster::Hit> TriangleCaster::cast_front(Vec3 origin, Vec3 direction,
                                                              std::span<const std::uint32_t> passed) const {
  return closest_hit(handles_->scene.get(), origin - handles_->centre, direction, passed, pass<true>);
}

bool TriangleCaster::is_blocked(Vec3 from, Vec3 to) const {
  const FlushDenormals flush;
  RTCIntersectContext context = incoherent_context();
  RTCRay ray = ray_along(from - handles_->centre, to - from, 1);
  rtcOccluded1(handles_->scene.get(), &context, &ray);
  return ray.tfar < 0;  // Embree sets -inf where blocked
}

std::optional<TriangleCaster::Hit> TriangleCaster::nearest(Vec3 point, Vec3 normal) const {
  NearestSearch search{handles_->positions, handles_->triangles, point - handles_->centre, normal, std::nullopt};
  const auto at = to_float(search.point);
  RTCPointQuery query{at[0], at[1], at[2], 0, std::numeric_limits<float>::infinity()};
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(handles_->scene.get(), &query, &context, visit_triangle, &search);
  return search.best;
}

}  // namespace alvor
