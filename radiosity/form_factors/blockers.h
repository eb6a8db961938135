#pragma once
// Blockers: the faces of a mesh, which may stand between others, joined into few large convex polygons.

#include "meshing/base_mesh.h"
#include "radiosity/form_factors/convex_polygon.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace alvor {

/// An axis-aligned bounding box.
struct Box {
  Vec3 low, high;

  static Box of(std::span<const Vec3> points);
  Box joined(const Box& other) const;
  bool touches(const Box& other) const;
};

/// A convex polygon made of one or more root patches that lie in one plane.
struct JoinedFace {
  std::vector<Vec3> corners;  ///< metres; at most 32, but as many as a single root patch has
  std::uint32_t root = 0;     ///< one of the root patches
};

/// Returns the root patches for which `counts` holds as polygons. Neighbours in one plane are joined as long as the result is
/// convex, so that a wall of many quads is one polygon. Backs of two-sided faces are left out.
std::vector<JoinedFace> joined_faces(
    const BaseMesh& mesh, const std::function<bool(std::uint32_t root)>& counts = [](std::uint32_t) { return true; });

/// All root patches as blockers of light, joined. Both sides block. Immutable; safe from any thread.
class Blockers {
 public:
  explicit Blockers(const BaseMesh& mesh);

  std::span<const ConvexPolygon> all() const { return polygons_; }
  /// Sets `found` to the blockers whose bounding boxes touch `box`. O(all().size()).
  void find_in(const Box& box, std::vector<const ConvexPolygon*>& found) const;

 private:
  std::vector<ConvexPolygon> polygons_;
  std::vector<Box> boxes_;
};

}  // namespace alvor
