#pragma once
// Tells whether any of many points lies beyond a plane, without testing each.

#include "meshing/vec3.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor {

/// A binary tree of bounding boxes over points. Immutable once built.
class PointTree {
 public:
  explicit PointTree(std::vector<Vec3> points);

  /// Returns whether dot(normal, p) > height for any point p. Takes some hundred steps, however many points there are.
  bool any_above(Vec3 normal, double height) const { return !nodes_.empty() && any_above(0, normal, height); }

 private:
  struct Node {
    Vec3 low, high;
    std::uint32_t first = 0, count = 0;  ///< range of its points
    std::uint32_t left = 0;              ///< left child; the right one is left + 1. 0: a leaf
  };
  void build(std::uint32_t node);
  bool any_above(std::uint32_t node, Vec3 normal, double height) const;

  std::vector<Vec3> points_;
  std::vector<Node> nodes_;
};

}  // namespace alvor
