#include "radiosity/rays/local_scene.h"

#include <algorithm>

namespace alvor {

namespace {

Float3 to_float(Vec3 p) { return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)}; }

LocalRoot make_local(const RootPatch& root, const std::array<Vec3, 4>& corners) {
  LocalRoot local;
  local.is_quad = root.corner_count == 4;
  local.twin = root.twin;
  const Vec3 edge_u = corners[1] - corners[0], edge_v = corners[local.is_quad ? 3 : 2] - corners[0];
  local.origin = to_float(corners[0]);
  local.edge_u = to_float(edge_u);
  local.edge_v = to_float(edge_v);
  const Vec3 twist = local.is_quad ? corners[2] - corners[1] - corners[3] + corners[0] : Vec3{};
  local.twist = to_float(twist);
  const double uu = dot(edge_u, edge_u), uv = dot(edge_u, edge_v), vv = dot(edge_v, edge_v);
  const double tu = dot(twist, edge_u), tv = dot(twist, edge_v), determinant = uu * vv - uv * uv;
  local.twist_u = static_cast<float>((tu * vv - tv * uv) / determinant);
  local.twist_v = static_cast<float>((tv * uu - tu * uv) / determinant);
  const Vec3 tangent = normalized(edge_u);
  local.tangent = to_float(tangent);
  local.bitangent = to_float(cross(root.normal, tangent));
  local.normal = to_float(root.normal);
  return local;
}

/// Converts Embree's coordinates on a quad, which are affine on each half of it, to bilinear ones. Three Newton steps on the
/// equations u + a u v = x and v + b u v = y.
Uv bilinear(const LocalRoot& root, double u, double v) {
  const double a = root.twist_u, b = root.twist_v;
  double x = u, y = v;
  if (u + v > 1) {
    x = (1 + a) - (1 - u) * (1 + a) - (1 - v) * a;
    y = (1 + b) - (1 - u) * b - (1 - v) * (1 + b);
  }
  for (int step = 0; step < 3; ++step) {
    const double fu = u + a * u * v - x, fv = v + b * u * v - y;
    const double uu = 1 + a * v, uv = a * u, vu = b * v, vv = 1 + b * u, inverse = 1 / (uu * vv - uv * vu);
    u -= (fu * vv - fv * uv) * inverse;
    v -= (fv * uu - fu * vu) * inverse;
  }
  return {u, v};
}

}  // namespace

LocalScene::LocalScene(const BaseMesh& mesh) : mesh_(&mesh), frame_{mesh.centre(), mesh.extent()}, visibility_(mesh, frame_) {
  for (const RootPatch& root : mesh.roots()) {
    std::array<Vec3, 4> corners;
    for (int c = 0; c < root.corner_count; ++c) corners[c] = frame_.to_local(root.corners[c]);
    corners_.push_back(corners);
    const LocalRoot& local = roots_.emplace_back(make_local(root, corners));
    has_triangles_ |= !local.is_quad;
    has_twisted_quads_ |= local.twist_u != 0 || local.twist_v != 0;
  }
}

void LocalScene::places_of_hits(const HitPacket& hits, std::uint32_t* path) const {
  static_assert(places_at_once == RayPacket::width);
  const auto for_each_hit = [&](auto&& body) {
    for (int lane = 0; lane < RayPacket::width; ++lane)
      if (hits.root[lane] != HitPacket::nothing) body(lane, roots_[hits.root[lane]]);
  };
  alignas(64) float u[RayPacket::width], v[RayPacket::width];
  std::copy_n(hits.u, RayPacket::width, u);
  std::copy_n(hits.v, RayPacket::width, v);
  if (has_twisted_quads_)
    for_each_hit([&](int lane, const LocalRoot& root) {
      if (root.twist_u == 0 && root.twist_v == 0) return;
      const Uv at = bilinear(root, u[lane], v[lane]);
      u[lane] = static_cast<float>(at.u), v[lane] = static_cast<float>(at.v);
    });
  finest_quad_paths(u, v, path);
  if (!has_triangles_) return;
  bool meets_triangle = false;
  for_each_hit([&](int, const LocalRoot& root) { meets_triangle |= !root.is_quad; });
  if (!meets_triangle) return;
  alignas(64) std::uint32_t triangle_path[RayPacket::width];
  finest_triangle_paths(u, v, triangle_path);
  for_each_hit([&](int lane, const LocalRoot& root) {
    if (!root.is_quad) path[lane] = triangle_path[lane];
  });
}

}  // namespace alvor
