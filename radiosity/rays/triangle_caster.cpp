#include "radiosity/rays/triangle_caster.h"

#include "radiosity/rays/embree_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace alvor {

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

/// The data that pass() reads while one ray is traced. Embree gives filters a pointer to `context`; because that is the first
/// member, they cast it to CastContext.
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
