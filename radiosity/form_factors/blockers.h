#pragma once
// What may stand between faces: the mesh as few large convex polygons.

#include "meshing/base_mesh.h"
#include "radiosity/form_factors/convex_polygon.h"

#include <span>
#include <vector>

namespace alvor {

struct Box {
  Vec3 low, high;

  static Box of(std::span<const Vec3> points);
  Box joined(const Box& other) const;
  bool touches(const Box& other) const;
};

/// Every root patch, neighbours in one plane joined into convex polygons as far as that goes: a wall of many quads blocks light
/// as one. Both sides block. Immutable; safe from any thread.
class Blockers {
 public:
  explicit Blockers(const BaseMesh& mesh);

  std::span<const ConvexPolygon> all() const { return polygons_; }
  /// Those whose bounding boxes touch `box`, into `found`. O(all().size()).
  void find_in(const Box& box, std::vector<const ConvexPolygon*>& found) const;

 private:
  std::vector<ConvexPolygon> polygons_;
  std::vector<Box> boxes_;
};

}  // namespace alvor
