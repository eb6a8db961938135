#pragma once
// The concentric map between the unit square and the unit disk, which preserves area (Shirley & Chiu 1997), and directions from
// it.

#include "meshing/patch_place.h"
#include "meshing/tangent_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {

struct DiskPoint {
  double x, y;
};

/// Maps the unit square to the unit disk, area-preserving and with low distortion.
inline DiskPoint concentric_disk(Uv p) {
  const double a = 2 * p.u - 1, b = 2 * p.v - 1;
  if (a == 0 && b == 0) return {0, 0};
  const double quarter = std::numbers::pi / 4;
  const bool wide = std::abs(a) > std::abs(b);
  const double r = wide ? a : b, phi = wide ? quarter * b / a : quarter * (2 - a / b);
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// Returns a direction about a normal that is cosine-distributed if `p` is uniform in the unit square (Nusselt 1928).
inline Vec3 cosine_direction(Vec3 normal, Uv p) {
  const TangentFrame plane(normal);
  const DiskPoint disk = concentric_disk(p);
  const double height = std::sqrt(std::max(0.0, 1 - disk.x * disk.x - disk.y * disk.y));
  return disk.x * plane.s + disk.y * plane.t + height * normal;
}

/// Returns the point of the unit square that concentric_disk() maps to a point of the unit disk.
inline Uv square_of_disk(DiskPoint d) {
  const double r = std::sqrt(d.x * d.x + d.y * d.y);
  if (r == 0) return {0.5, 0.5};
  const double to_side = 4 / std::numbers::pi;
  double a, b;
  if (std::abs(d.x) > std::abs(d.y)) {
    a = d.x > 0 ? r : -r;
    b = a * to_side * std::atan(d.y / d.x);
  } else {
    b = d.y > 0 ? r : -r;
    a = b * to_side * std::atan(d.x / d.y);
  }
  return {(a + 1) / 2, (b + 1) / 2};
}

}  // namespace alvor
