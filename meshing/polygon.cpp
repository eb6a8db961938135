#include "meshing/polygon.h"

#include "meshing/ear_clipping.h"

#include <algorithm>

namespace alvor {

namespace {

/// Returns whether the quad is planar and strictly convex: every corner turns left about the normal, and no corner leaves the
/// plane.
bool is_planar_convex_quad(std::span<const Vec3> p, Vec3 normal) {
  // Rays hit two triangles while points of the patch lie on the bilinear surface. The two must differ by less than the offset at
  // which rays start.
  constexpr double planar = 4e-6, strictly_convex = 1e-6;
  const double size = std::max(length(p[2] - p[0]), length(p[3] - p[1]));
  if (std::abs(dot(p[2] - p[0], normal)) > planar * size || std::abs(dot(p[3] - p[1], normal)) > planar * size) return false;
  if (std::abs(dot((p[0] + p[2]) - (p[1] + p[3]), normal)) > planar * size) return false;
  for (int c = 0; c < 4; ++c) {
    const Vec3 in = p[c] - p[(c + 3) % 4], out = p[(c + 1) % 4] - p[c];
    if (dot(cross(in, out), normal) <= strictly_convex * length(in) * length(out)) return false;
  }
  return true;
}

}  // namespace

std::array<double, 3> barycentric(Vec3 point, Vec3 a, Vec3 b, Vec3 c) {
  const Vec3 normal = cross(b - a, c - a);
  const double square = dot(normal, normal);
  const double at_b = dot(cross(point - a, c - a), normal) / square, at_c = dot(cross(b - a, point - a), normal) / square;
  return {1 - at_b - at_c, at_b, at_c};
}

Vec3 double_area_vector(std::span<const Vec3> polygon) {
  Vec3 sum;
  for (std::size_t c = 2; c < polygon.size(); ++c) sum += cross(polygon[c - 1] - polygon[0], polygon[c] - polygon[0]);
  return sum;
}

std::vector<Piece> pieces_of(std::span<const Vec3> polygon) {
  if (polygon.size() == 3) return {{0, 1, 2, no_corner}};
  const Vec3 area = double_area_vector(polygon);
  if (!(length(area) > 0)) return {};
  const Vec3 normal = normalized(area);
  if (polygon.size() == 4 && is_planar_convex_quad(polygon, normal)) return {{0, 1, 2, 3}};
  std::vector<Piece> pieces;
  for (const auto& [a, b, c] : clip_ears(polygon, normal)) pieces.push_back({a, b, c, no_corner});
  return pieces;
}

}  // namespace alvor
