#pragma once
// Convex planar polygons and their parts on one side of a plane.

#include "meshing/vec3.h"

#include <algorithm>
#include <cassert>
#include <initializer_list>
#include <span>

namespace alvor {

/// The plane of the points with height 0.
struct Plane {
  Vec3 normal;  ///< need not be unit; heights are in units of its length
  double offset = 0;

  double height(Vec3 p) const { return dot(normal, p) - offset; }
};

/// A convex planar polygon: its corners in order. It allocates nothing; a copy copies only the corners that there are.
class ConvexPolygon {
 public:
  /// Most corners: 64 of a face (see FacePolygons) and 16 that cuts add. Chosen; half and double give the same solutions
  /// (docs/design/constants.md).
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
  /// Returns whether there are too few corners for an area.
  bool is_empty() const { return count_ < 3; }
  std::span<const Vec3> corners() const { return {corners_, static_cast<std::size_t>(count_)}; }

 private:
  int count_ = 0;
  union {  // not initialised: most polygons use a few corners
    Vec3 corners_[capacity];
  };
};

/// Returns the area vector of a polygon: along the normal of counter-clockwise corners, as long as the area.
Vec3 area_vector(std::span<const Vec3> polygon);
/// Returns the plane of a polygon, with unit normal to the polygon's front. Requires: an area greater than 0.
Plane plane_of(std::span<const Vec3> polygon);
/// Returns whether no corner turns the wrong way. Requires: planar.
bool is_convex(std::span<const Vec3> polygon);

/// Returns whether no corner is lower than `slack` under the plane.
inline bool lies_above(std::span<const Vec3> polygon, const Plane& plane, double slack) {
  return std::ranges::all_of(polygon, [&](const Vec3& corner) { return plane.height(corner) >= -slack; });
}
/// Returns whether no corner is higher than `slack` over the plane.
inline bool lies_below(std::span<const Vec3> polygon, const Plane& plane, double slack) {
  return std::ranges::all_of(polygon, [&](const Vec3& corner) { return plane.height(corner) <= slack; });
}

/// Returns the part of the polygon at heights >= 0 (Sutherland & Hodgman 1974). It has at most one corner more than the polygon.
ConvexPolygon part_above(const ConvexPolygon& polygon, const Plane& plane);

/// Returns the part of the polygon above all `sides`; empty if it reaches above one of them by no more than `slack`.
ConvexPolygon part_inside(const ConvexPolygon& polygon, std::span<const Plane> sides, double slack);

/// Cuts the polygon along the plane: `below` becomes its part at heights <= 0, and the polygon keeps its part at heights >= 0. A
/// part without area is empty; a polygon in the plane counts as above. Requires: `below` is another object.
void move_part_below(ConvexPolygon& polygon, const Plane& plane, ConvexPolygon& below);

}  // namespace alvor
