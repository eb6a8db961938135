#include "radiosity/hemicube.h"

#include <cmath>
#include <numbers>

namespace alvor {

namespace {

/// Form factor to the rectangle [0, x] x [0, y] at height 1; odd in both (Howell B-3).
double top(double x, double y) {
  const double p = std::sqrt(1 + x * x), q = std::sqrt(1 + y * y);
  return (x / p * std::atan(y / p) + y / q * std::atan(x / q)) / (2 * std::numbers::pi);
}

/// Form factor to the rectangle [0, y] x [0, z] of the wall at distance 1, z along the normal; odd in y (Howell B-5).
double side(double y, double z) {
  const double q = std::sqrt(1 + z * z);
  return (std::atan(y) - std::atan(y / q) / q) / (2 * std::numbers::pi);
}

template <class FormFactor>
double over(FormFactor&& f, double s0, double s1, double t0, double t1) {
  return f(s1, t1) - f(s0, t1) - f(s1, t0) + f(s0, t0);
}

}  // namespace

Hemicube::Hemicube(int resolution) {
  const double step = 2.0 / resolution;
  const auto at = [&](int n) { return -1 + n * step; };
  for (int j = 0; j < resolution; ++j)
    for (int i = 0; i < resolution; ++i)
      cells_.push_back({{at(i), at(j), 1}, {step, 0, 0}, {0, step, 0}, over(top, at(i), at(i + 1), at(j), at(j + 1))});
  for (int wall = 0; wall < 4; ++wall) {
    const Vec3 out = wall == 0 ? Vec3{1, 0, 0} : wall == 1 ? Vec3{-1, 0, 0} : wall == 2 ? Vec3{0, 1, 0} : Vec3{0, -1, 0};
    const Vec3 along{-out.y, out.x, 0};
    for (int j = 0; j < resolution / 2; ++j)
      for (int i = 0; i < resolution; ++i)
        cells_.push_back({out + at(i) * along + Vec3{0, 0, j * step},
                          step * along,
                          {0, 0, step},
                          over(side, at(i), at(i + 1), j * step, (j + 1) * step)});
  }
}

}  // namespace alvor
