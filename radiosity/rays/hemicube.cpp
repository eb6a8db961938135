#include "radiosity/rays/hemicube.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

/// Returns the form factor from the point to the rectangle [0, x] x [0, y] at height 1. Odd in x and in y (Howell B-3).
double top(double x, double y) {
  const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * std::numbers::pi);
}

/// Returns the form factor from the point to the rectangle [0, y] x [0, z] of the wall at distance 1, z along the point's normal.
/// Odd in y (Howell B-5).
double side(double y, double z) {
  const double q = std::sqrt(1 + z * z);
  return (std::atan(y) - std::atan(y / q) / q) / (2 * std::numbers::pi);
}

template <class FormFactor>
double over(FormFactor&& f, double s0, double s1, double t0, double t1) {
  return f(s1, t1) - f(s0, t1) - f(s1, t0) + f(s0, t0);
}

}  // namespace

Hemicube::Hemicube(const HemicubeGrid& grid) {
  assert(grid.top_s >= 1 && grid.top_t >= 1 && grid.side_along >= 1 && grid.side_up >= 1);
  const auto edge = [](int n, int count) { return -1 + n * (2.0 / count); };
  for (int j = 0; j < grid.top_t; ++j)
    for (int i = 0; i < grid.top_s; ++i) {
      const double s0 = edge(i, grid.top_s), s1 = edge(i + 1, grid.top_s), t0 = edge(j, grid.top_t), t1 = edge(j + 1, grid.top_t);
      cells_.push_back({{s0, t0, 1}, {s1 - s0, 0, 0}, {0, t1 - t0, 0}, over(top, s0, s1, t0, t1)});
    }
  for (const Vec3 out : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0}}) {
    const Vec3 along{-out.y, out.x, 0};
    for (int j = 0; j < grid.side_up; ++j)
      for (int i = 0; i < grid.side_along; ++i) {
        const double s0 = edge(i, grid.side_along), s1 = edge(i + 1, grid.side_along);
        const double z0 = static_cast<double>(j) / grid.side_up, z1 = static_cast<double>(j + 1) / grid.side_up;
        cells_.push_back({out + s0 * along + Vec3{0, 0, z0}, (s1 - s0) * along, {0, 0, z1 - z0}, over(side, s0, s1, z0, z1)});
      }
  }
}

}  // namespace alvor
