#pragma once
// Where light of the sky can enter a scene.

#include "radiosity/direct/flat_rectangle.h"
#include "radiosity/rays/local_scene.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace alvor {

/// Decides from where each face gets the light of the sky, by rays that are sent from all faces. Open faces, from which many rays
/// leave the scene, look for it in all directions. The others, such as the walls of a room with windows, look for it only through
/// the exits: rectangles about windows, doors and what else their rays left by (see find_openings). Each direction counts at the
/// first of the exits that it crosses. A hole that no ray found is left out; of 2^18 rays it would bring less than one in 2^18 of
/// the light.
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

  /// Returns whether a ray that crosses exit `which` counts there.
  bool counts_at(std::size_t which, Vec3 from, Vec3 direction) const {
    for (std::size_t before = 0; before < which; ++before)
      if (exits[before].crossing(from, direction)) return false;
    return true;
  }

  std::vector<bool> is_open;         ///< by root
  std::vector<FlatRectangle> exits;  ///< empty if no closed face sees the sky
  bool any_open = false;
};

}  // namespace alvor
