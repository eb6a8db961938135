#pragma once
// Convex planar polygons and what planes cut off them.

#include "meshing/vec3.h"

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <span>

namespace alvor {

struct Plane {
  Vec3 normal;  ///< need not be unit; heights are in its unit
  double offset = 0;

  double height(Vec3 p) const { return dot(normal, p) - offset; }
};

/// Corners in order. No allocation; a copy costs as many corners as there are.
class ConvexPolygon {
 public:
  static constexpr int capacity = 80;

  ConvexPolygon() {}
  /// Requires: corners.size() <= capacity.
  explicit ConvexPolygon(std::span<const Vec3> corners) {
    for (const Vec3& corner : corners) add(corner);
  }
  ConvexPolygon(const ConvexPolygon& other) { *this = other; }
  ConvexPolygon& operator=(const ConvexPolygon& other) {
    count_ = other.count_;
    std::copy_n(other.corners_, count_, corners_);
    return *this;
  }

  void add(Vec3 corner) {
    assert(count_ < capacity);
    corners_[count_++] = corner;
  }
  void clear() { count_ = 0; }
  /// Nothing with an area.
  bool is_empty() const { return count_ < 3; }
  std::span<const Vec3> corners() const { return {corners_, static_cast<std::size_t>(count_)}; }

 private:
  int count_ = 0;
  union {  // not initialised: most polygons use a few corners
    Vec3 corners_[capacity];
  };
};

/// Area vector: along the normal of counter-clockwise corners, as long as the area.
Vec3 area_vector(std::span<const Vec3> polygon);
/// The plane of a polygon, unit normal, the polygon's front upwards. Requires: an area greater than 0.
Plane plane_of(std::span<const Vec3> polygon);
/// True if no corner turns the wrong way. Requires: planar.
bool is_convex(std::span<const Vec3> polygon);

/// The part of the polygon at heights >= 0 (Sutherland & Hodgman 1974). One corner more at most.
ConvexPolygon part_above(const ConvexPolygon& polygon, const Plane& plane);

}  // namespace alvor
