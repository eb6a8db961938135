#pragma once

#include "meshing/vec3.h"

#include <algorithm>
#include <limits>

namespace alvor {

/// A box along the axes; empty until something is added.
struct BoundingBox {
  Vec3 low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
           std::numeric_limits<double>::infinity()};
  Vec3 high = -low;

  void add(Vec3 p) {
    low = lower(low, p);
    high = upper(high, p);
  }
  void add(const BoundingBox& other) {
    low = lower(low, other.low);
    high = upper(high, other.high);
  }
  bool is_empty() const { return !(low.x <= high.x); }
  bool holds(Vec3 p) const { return lower(low, p) == low && upper(high, p) == high; }
  double longest_side() const { return std::max({high.x - low.x, high.y - low.y, high.z - low.z}); }
};

}  // namespace alvor
