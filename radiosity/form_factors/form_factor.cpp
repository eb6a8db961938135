#include "radiosity/form_factors/form_factor.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace alvor {

namespace {

/// The part of a polygon of up to four corners above a horizon. It has at most five corners; six if the polygon is seen edge on,
/// where rounding bends it.
struct ClippedPolygon {
  std::array<Vec3, 6> corner;
  int count = 0;
  void add(Vec3 p) { corner[count++] = p; }
};

/// Returns the part of the polygon above the point's horizon, with corners relative to the point.
ClippedPolygon above_horizon(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  ClippedPolygon kept;
  Vec3 before = polygon.back() - point;
  double height_before = dot(before, normal);
  for (const Vec3& corner : polygon) {
    const Vec3 here = corner - point;
    const double height = dot(here, normal);
    if ((height > 0) != (height_before > 0)) kept.add(lerp(before, here, height_before / (height_before - height)));
    if (height > 0) kept.add(here);
    before = here;
    height_before = height;
  }
  return kept;
}

/// A number for each of four edges.
using Lanes [[gnu::vector_size(4 * sizeof(double))]] = double;

Lanes root(Lanes squares) {
  for (int e = 0; e < 4; ++e) squares[e] = std::sqrt(squares[e]);
  return squares;
}

/// Returns the polynomial of these coefficients, the lowest power first. Even and odd powers are summed side by side.
template <std::size_t count>
Lanes polynomial(Lanes x, const std::array<double, count>& coefficient) {
  static_assert(count % 2 == 0);
  const Lanes square = x * x;
  Lanes even{}, odd{};
  for (std::size_t n = count; n > 0; n -= 2) {
    odd = odd * square + coefficient[n - 1];
    even = even * square + coefficient[n - 2];
  }
  return even + x * odd;
}

constexpr double tiny = std::numeric_limits<double>::min();  // added to divisors, so that 0 / 0 is 0

/// Returns angles in [0, pi] of which the sine and the cosine are given, both multiplied by the same factor; to 4e-15, and 0
/// where the sine is 0. std::atan2 takes twice as long for four.
Lanes angle_of(Lanes sine, Lanes cosine) {
  const Lanes size = root(sine * sine + cosine * cosine);
  // size + cosine, without loss of digits where the cosine is negative.
  const Lanes along = cosine > 0 ? size + cosine : sine * sine / (size - cosine + tiny);  // tan(angle / 2) = sine / along
  const Lanes x = sine / (along + root(along * along + sine * sine) + tiny);              // tan(angle / 4), in [0, 1]
  // Coefficients of atan(x) / x in powers of x^2: interpolation at the 18 Chebyshev nodes of [0, 1].
  static constexpr std::array<double, 18> series{
      0.9999999999999988,     -0.3333333333325326,   0.19999999991318923,   -0.14285713910445952,  0.11111102500071403,
      -0.09090787977311511,   0.07691170146952092,   -0.06659120391183469,  0.058455895046354144,  -0.05127834268921699,
      0.04377201422752661,    -0.03487468932582437,  0.02458939003908098,   -0.014459010386771196, 0.006642746866014527,
      -0.0021984457570296298, 0.0004611614891069217, -4.572637327429321e-05};
  return 4 * x * polynomial(x * x, series);
}

/// Four vectors.
struct VecLanes {
  Lanes x, y, z;

  static VecLanes of(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return {Lanes{a.x, b.x, c.x, d.x}, Lanes{a.y, b.y, c.y, d.y}, Lanes{a.z, b.z, c.z, d.z}};
  }
  VecLanes operator-(const Vec3& v) const { return {x - v.x, y - v.y, z - v.z}; }
};
Lanes dot(const VecLanes& a, const VecLanes& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
VecLanes cross(const VecLanes& a, const VecLanes& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Returns Lambert's sum over the edges of a polygon, clamped to [0, 1].
double lambert_sum(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  if (polygon.empty()) return 0;
  Lanes sum{};
  const std::size_t last = polygon.size() - 1;
  const auto corner = [&](std::size_t c) -> const Vec3& { return polygon[std::min(c, last)]; };
  const Vec3* before = &polygon.back();
  for (std::size_t c = 0; c <= last; c += 4) {
    // The ends of four edges. Beyond the last edge both are one corner, which adds no more than rounding.
    const VecLanes to = VecLanes::of(corner(c), corner(c + 1), corner(c + 2), corner(c + 3));
    const VecLanes from = VecLanes::of(*before, corner(c), corner(c + 1), corner(c + 2));
    before = &corner(c + 3);
    const VecLanes a = from - point, b = to - point, edge_normal = cross(b, a);
    const Lanes sine = root(dot(edge_normal, edge_normal));
    const Lanes facing = edge_normal.x * normal.x + edge_normal.y * normal.y + edge_normal.z * normal.z;
    sum += angle_of(sine, dot(a, b)) * facing / (sine + tiny);
  }
  return std::clamp((sum[0] + sum[1] + sum[2] + sum[3]) / (2 * std::numbers::pi), 0.0, 1.0);
}

}  // namespace

double point_to_polygon(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  assert(polygon.size() == 3 || polygon.size() == 4);
  const ClippedPolygon seen = above_horizon(point, normal, polygon);
  return lambert_sum({}, normal, {seen.corner.data(), static_cast<std::size_t>(seen.count)});
}

double point_to_polygon_above(Vec3 point, Vec3 normal, std::span<const Vec3> polygon) {
  return lambert_sum(point, normal, polygon);
}

}  // namespace alvor
