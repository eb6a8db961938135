#pragma once
// Finds rooms that light can neither leave nor enter.

#include "meshing/base_mesh.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// A closed, convex room whose walls' fronts look inwards: a connected part of the mesh without open edges, all of which lies on
/// or in front of the plane of each of its faces.
struct SealedRoom {
  struct Plane {
    Vec3 normal;    ///< inwards
    double height;  ///< dot(normal, point - origin) of the plane's points
  };
  enum class Side { inside, outside, both };
  /// Returns on which side of the walls the front of a face is. Walls of the room are inside; faces that touch them from without
  /// are outside.
  Side side_of(const RootPatch& face) const;
  /// Returns whether a point is in the room, on its walls, or outside by at most `margin`, m. A negative margin asks for that
  /// distance from all walls.
  bool holds(Vec3 point, double margin) const;

  Vec3 origin;
  std::vector<Plane> planes;
  Vec3 low, high;        ///< corners of its bounding box, m
  double volume = 0;     ///< m3
  double tolerance = 0;  ///< a point closer to a plane than this lies on it, m
};

/// Returns the sealed rooms, smallest first: the 64 largest, those of at most 64 planes. A room that is not found counts as open,
/// which is safe.
std::vector<SealedRoom> find_sealed_rooms(const BaseMesh& mesh);

}  // namespace alvor
