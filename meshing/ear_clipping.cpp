#include "meshing/ear_clipping.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace alvor {

namespace {

struct Point {
  double x = 0, y = 0;
};

/// Returns twice the signed area of the triangle: positive if a, b, c turn left.
double turn(Point a, Point b, Point c) { return (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x); }

std::vector<Point> projected(std::span<const Vec3> polygon, Vec3 normal) {
  const Vec3 axis = std::abs(normal.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 u = normalized(cross(axis, normal)), v = cross(normal, u);
  std::vector<Point> points;
  for (const Vec3& corner : polygon) points.push_back({dot(corner - polygon[0], u), dot(corner - polygon[0], v)});
  return points;
}

struct Triangle {
  std::array<std::uint32_t, 3> corners;
  std::array<Point, 3> at;

  bool holds(Point p) const { return turn(at[0], at[1], p) >= 0 && turn(at[1], at[2], p) >= 0 && turn(at[2], at[0], p) >= 0; }
};

struct Box {
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()}, high{-low.x, -low.y};

  void add(Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
  /// Returns whether the whole box lies to the right of the line from a to b.
  bool is_right_of(Point a, Point b) const {
    const Point leftmost{b.y > a.y ? low.x : high.x, b.x > a.x ? high.y : low.y};
    return turn(a, b, leftmost) < 0;
  }
};

/// The corners not yet cut off, in a balanced tree of boxes (k-d tree; Bentley 1975). Node n has the children 2n + 1 and 2n + 2.
class CornerTree {
 public:
  explicit CornerTree(std::span<const Point> points) : points_(points), order_(points.size()), leaf_of_(points.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    build(0, 0, order_.size());
  }
  void remove(std::uint32_t corner) {
    gone_[corner] = true;
    for (std::size_t node = leaf_of_[corner];; node = (node - 1) / 2) {
      --nodes_[node].left;
      if (node == 0) return;
    }
  }
  /// Returns whether the triangle contains a corner that is not its own.
  bool has_other_in(const Triangle& triangle) const { return has_other_in(triangle, 0); }

 private:
  struct Node {
    Box box;
    std::size_t begin = 0, end = 0;  ///< range in order_
    std::size_t left = 0;            ///< corners of the range that are not removed
  };
  static constexpr std::size_t most_in_leaf = 8;

  bool is_leaf(const Node& node) const { return node.end - node.begin <= most_in_leaf; }
  void build(std::size_t number, std::size_t begin, std::size_t end);
  bool has_other_in(const Triangle& triangle, std::size_t number) const;

  const std::span<const Point> points_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> leaf_of_;
  std::vector<bool> gone_ = std::vector<bool>(points_.size());
};

void CornerTree::build(std::size_t number, std::size_t begin, std::size_t end) {
  if (nodes_.size() <= number) nodes_.resize(number + 1);
  Node node{{}, begin, end, end - begin};
  for (std::size_t k = begin; k < end; ++k) node.box.add(points_[order_[k]]);
  nodes_[number] = node;
  if (is_leaf(node)) {
    for (std::size_t k = begin; k < end; ++k) leaf_of_[order_[k]] = number;
    return;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const bool is_wide = node.box.high.x - node.box.low.x > node.box.high.y - node.box.low.y;
  const auto at = [&](std::size_t k) { return order_.begin() + static_cast<std::ptrdiff_t>(k); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return is_wide ? points_[a].x < points_[b].x : points_[a].y < points_[b].y;
  });
  build(2 * number + 1, begin, middle);
  build(2 * number + 2, middle, end);
}

bool CornerTree::has_other_in(const Triangle& triangle, std::size_t number) const {
  const Node& node = nodes_[number];
  if (node.left == 0) return false;
  for (int e = 0; e < 3; ++e)
    if (node.box.is_right_of(triangle.at[e], triangle.at[(e + 1) % 3])) return false;
  if (!is_leaf(node)) return has_other_in(triangle, 2 * number + 1) || has_other_in(triangle, 2 * number + 2);
  return std::any_of(order_.begin() + static_cast<std::ptrdiff_t>(node.begin),
                     order_.begin() + static_cast<std::ptrdiff_t>(node.end), [&](std::uint32_t corner) {
                       return !gone_[corner] && std::ranges::find(triangle.corners, corner) == triangle.corners.end() &&
                              triangle.holds(points_[corner]);
                     });
}

class EarClipper {
 public:
  EarClipper(std::span<const Vec3> polygon, Vec3 normal)
      : points_(projected(polygon, normal)), tree_(points_), before_(points_.size()), behind_(points_.size()) {
    const auto count = static_cast<std::uint32_t>(points_.size());
    for (std::uint32_t corner = 0; corner < count; ++corner) {
      before_[corner] = (corner + count - 1) % count;
      behind_[corner] = (corner + 1) % count;
    }
    find_ears();
  }

  std::vector<std::array<std::uint32_t, 3>> run() {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (std::size_t left = points_.size(); left >= 3; --left) {
      // If the polygon touches itself, cutting a corner off may have made others into ears.
      if (ears_.empty() && left < left_at_look_ && looks_ < most_looks) find_ears(left);
      triangles.push_back(cut(next_ear()));
    }
    return triangles;
  }

 private:
  static constexpr int most_looks =
      50;  // a polygon that needs more crosses itself again and again, and is cut without a test for ears

  Triangle triangle_at(std::uint32_t corner) const {
    const std::uint32_t a = before_[corner], c = behind_[corner];
    return {{a, corner, c}, {points_[a], points_[corner], points_[c]}};
  }
  void find_ears(std::size_t left) {
    ++looks_;
    left_at_look_ = left;
    std::uint32_t corner = first_;
    do see(corner);
    while ((corner = behind_[corner]) != first_);
  }
  void find_ears() { find_ears(points_.size()); }
  void see(std::uint32_t corner) {
    const Triangle triangle = triangle_at(corner);
    const bool is_ear = turn(triangle.at[0], triangle.at[1], triangle.at[2]) > 0 && !tree_.has_other_in(triangle);
    if (is_ear) ears_.insert(corner);
    else ears_.erase(corner);
  }
  /// Returns the corner to cut next; the first corner is taken last. Without an ear, returns a straight or crossing corner.
  std::uint32_t next_ear() const {
    if (ears_.empty()) return behind_[first_];
    const auto ear = ears_.upper_bound(first_);
    return ear == ears_.end() ? first_ : *ear;
  }
  std::array<std::uint32_t, 3> cut(std::uint32_t corner) {
    const std::uint32_t a = before_[corner], c = behind_[corner];
    behind_[a] = c;
    before_[c] = a;
    ears_.erase(corner);
    tree_.remove(corner);
    if (corner == first_) first_ = c;
    see(a);
    see(c);
    return {a, corner, c};
  }

  const std::vector<Point> points_;
  CornerTree tree_;
  std::vector<std::uint32_t> before_, behind_;  ///< neighbours among the corners that are left
  std::uint32_t first_ = 0;                     ///< the corner of the lowest number that is left
  std::set<std::uint32_t> ears_;
  int looks_ = 0;
  std::size_t left_at_look_ = 0;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> clip_ears(std::span<const Vec3> polygon, Vec3 normal) {
  return EarClipper(polygon, normal).run();
}

}  // namespace alvor
