#pragma once
// Where light of the sky can enter a scene.

#include "radiosity/rays/local_scene.h"

#include <array>
#include <cstdint>
#include <vector>

namespace alvor {

/// A rectangle on the scene's bounding box through which rays leave the scene. Local units (see LocalFrame).
struct SkyExit {
  Vec3 corner, side_u, side_v;  ///< the sides are perpendicular to each other
  Vec3 inwards;                 ///< unit normal
  Vec3 at(double u, double v) const { return corner + u * side_u + v * side_v; }
  double area() const { return length(side_u) * length(side_v); }
};

/// Decides from where each face gets the light of the sky, by rays that are sent from all faces. Open faces, from which many rays
/// leave the scene, look for it in all directions. The others, such as the walls of a room with windows, look for it only through
/// the exits: rectangles about the places where their rays left the bounding box. A hole that no ray found is left out; of 2^18
/// rays it would bring less than one in 2^18 of the light.
struct SkyExits {
  /// The way out of one ray, and the part of its face's area that the ray stands for, local units squared. For estimates of
  /// power.
  struct WayOut {
    Vec3 direction;
    double area;
    bool is_of_open;
  };
  /// Appends the ways out of all rays to `ways_out`.
  SkyExits(const LocalScene& scene, std::vector<WayOut>& ways_out);

  std::vector<bool> is_open;   ///< by root
  std::vector<SkyExit> exits;  ///< empty if no closed face sees the sky
  bool any_open = false;
};

}  // namespace alvor
