#pragma once
// A table over the directions of surfaces.

#include "meshing/tangent_frame.h"
#include "meshing/vec3.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace alvor {

/// Numbers by the normal of a surface, for example the irradiance from a sky; bilinear between `tilts` angles from a zenith and
/// `turns` azimuths. Normals along the coordinate axes are nodes, if the zenith is one of these and both numbers are even.
class NormalTable {
 public:
  /// Computes of_normal(Vec3) at all nodes, in parallel.
  template <class OfNormal>
  NormalTable(Vec3 zenith, int tilts, int turns, const OfNormal& of_normal)
      : zenith_(zenith), axes_(zenith), tilts_(tilts), turns_(turns), nodes_(static_cast<std::size_t>((tilts + 1) * turns)) {
    tbb::parallel_for(0, tilts + 1, [&](int tilt) {
      for (int turn = 0; turn < turns; ++turn) {
        const double a = std::numbers::pi * tilt / tilts, b = 2 * std::numbers::pi * turn / turns;
        const Vec3 normal = std::cos(a) * zenith_ + std::sin(a) * std::cos(b) * axes_.s + std::sin(a) * std::sin(b) * axes_.t;
        nodes_[static_cast<std::size_t>(tilt * turns + turn)] = static_cast<float>(of_normal(normal));
      }
    });
  }

  double at(Vec3 normal) const {
    const double tilt = std::acos(std::clamp(dot(normal, zenith_), -1.0, 1.0)) / std::numbers::pi * tilts_;
    double turn = std::atan2(dot(normal, axes_.t), dot(normal, axes_.s)) / (2 * std::numbers::pi) * turns_;
    if (turn < 0) turn += turns_;
    const int row = std::min(tilts_ - 1, static_cast<int>(tilt)), column = std::min(turns_ - 1, static_cast<int>(turn));
    const double u = turn - column, v = tilt - row;
    return (1 - v) * ((1 - u) * node(row, column) + u * node(row, column + 1)) +
           v * ((1 - u) * node(row + 1, column) + u * node(row + 1, column + 1));
  }

 private:
  double node(int tilt, int turn) const { return double{nodes_[static_cast<std::size_t>(tilt * turns_ + turn % turns_)]}; }

  Vec3 zenith_;
  TangentFrame axes_;
  int tilts_, turns_;
  std::vector<float> nodes_;
};

}  // namespace alvor
