#include "meshing/polygon.h"

#include <algorithm>
#include <numeric>

namespace alvor {

namespace {

/// Planarity and convexity at the four corners: every corner turns left about the normal, and no corner leaves the plane.
bool is_planar_convex_quad(std::span<const Vec3> p, Vec3 normal) {
  // Rays see two triangles, points of the patch lie on the bilinear surface: these may differ by less than rays start above it.
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

bool lies_inside(Vec3 p, Vec3 a, Vec3 b, Vec3 c, Vec3 normal) {
  return dot(cross(b - a, p - a), normal) >= 0 && dot(cross(c - b, p - b), normal) >= 0 && dot(cross(a - c, p - c), normal) >= 0;
}

bool is_ear(std::span<const Vec3> p, std::span<const std::uint32_t> ring, std::size_t k, Vec3 normal) {
  const std::size_t n = ring.size();
  const std::uint32_t ia = ring[(k + n - 1) % n], ib = ring[k], ic = ring[(k + 1) % n];
  if (dot(cross(p[ib] - p[ia], p[ic] - p[ib]), normal) <= 0) return false;
  return std::ranges::none_of(
      ring, [&](std::uint32_t i) { return i != ia && i != ib && i != ic && lies_inside(p[i], p[ia], p[ib], p[ic], normal); });
}

// Starts at the second corner: a convex polygon becomes the fan about its first, as in most programs.
std::vector<Piece> clip_ears(std::span<const Vec3> polygon, Vec3 normal) {
  std::vector<std::uint32_t> ring(polygon.size());
  std::iota(ring.begin(), ring.end(), 0u);
  std::vector<Piece> pieces;
  while (ring.size() >= 3) {
    const std::size_t n = ring.size();
    std::size_t tried = 0;
    while (tried < n && !is_ear(polygon, ring, (tried + 1) % n, normal)) ++tried;
    const std::size_t ear = (tried + 1) % n;  // all tried: it crosses itself or has straight corners left; cut anyway
    pieces.push_back({ring[(ear + n - 1) % n], ring[ear], ring[(ear + 1) % n], no_corner});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return pieces;
}

}  // namespace

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
  return clip_ears(polygon, normal);
}

}  // namespace alvor
