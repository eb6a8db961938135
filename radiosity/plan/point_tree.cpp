#include "radiosity/plan/point_tree.h"

#include <algorithm>

namespace alvor {

namespace {

// Most points of a leaf of the tree. Chosen; half and double give the same solutions (docs/design/constants.md).
constexpr std::uint32_t points_per_leaf = 8;

}  // namespace

PointTree::PointTree(std::vector<Vec3> points) : points_(std::move(points)) {
  if (points_.empty()) return;
  nodes_.push_back({{}, {}, 0, static_cast<std::uint32_t>(points_.size())});
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) build(node);
}

void PointTree::build(std::uint32_t node) {
  const std::uint32_t first = nodes_[node].first, count = nodes_[node].count;
  const auto points = std::span(points_).subspan(first, count);
  Vec3 low = points[0], high = points[0];
  for (const Vec3& p : points) {
    low = lower(low, p);
    high = upper(high, p);
  }
  nodes_[node].low = low;
  nodes_[node].high = high;
  if (count <= points_per_leaf) return;
  const Vec3 size = high - low;
  const double longest = std::max({size.x, size.y, size.z});
  const auto along = [&](const Vec3& p) { return longest == size.x ? p.x : longest == size.y ? p.y : p.z; };
  std::ranges::nth_element(points, points.begin() + count / 2, {}, along);
  nodes_[node].left = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({{}, {}, first, count / 2});
  nodes_.push_back({{}, {}, first + count / 2, count - count / 2});
}

bool PointTree::any_above(std::uint32_t node, Vec3 normal, double height) const {
  const Node& n = nodes_[node];
  const auto highest = [](double along, double low, double high) { return along * (along > 0 ? high : low); };
  const double bound =
      highest(normal.x, n.low.x, n.high.x) + highest(normal.y, n.low.y, n.high.y) + highest(normal.z, n.low.z, n.high.z);
  if (bound <= height) return false;
  if (n.left != 0) return any_above(n.left, normal, height) || any_above(n.left + 1, normal, height);
  return std::ranges::any_of(std::span(points_).subspan(n.first, n.count),
                             [&](const Vec3& p) { return dot(normal, p) > height; });
}

}  // namespace alvor
