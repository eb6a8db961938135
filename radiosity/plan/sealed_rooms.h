#pragma once
// Rooms that light can neither leave nor enter.

#include "meshing/base_mesh.h"

#include <cstdint>
#include <vector>

namespace alvor {

/// A closed, convex surface whose fronts look inwards: a connected part of the mesh without open edges, all of which lies on or
/// in front of each of its own faces' planes.
struct SealedRoom {
  struct Plane {
    Vec3 normal;    ///< inwards
    double height;  ///< dot(normal, point - origin) of its points
  };
  enum class Side { inside, outside, both };
  /// Where the front of a face is. Walls of the room are inside; what touches them from without is outside.
  Side side_of(const RootPatch& face) const;

  Vec3 origin;
  std::vector<Plane> planes;
  Vec3 low, high;        ///< of its bounding box
  double volume = 0;     ///< m3
  double tolerance = 0;  ///< what is closer to a plane lies on it, m
};

/// The largest rooms, at most 64 and of at most 64 planes each, smallest first: what is not found only counts as open.
std::vector<SealedRoom> find_sealed_rooms(const BaseMesh& mesh);

}  // namespace alvor
