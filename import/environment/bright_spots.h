#pragma once
// Small bright parts of environment maps, such as the sun.

#include "meshing/environment_map.h"

#include <vector>

namespace alvor {

/// The light that a small part of a map brings more than its surroundings.
struct BrightSpot {
  Vec3 towards;                 ///< unit; coordinates of the grid
  Rgb irradiance;               ///< of a surface that faces the spot, W/m2 or lx
  double angular_diameter = 0;  ///< of a disk that is as large as the spot, radians
};

/// Takes at most four bright spots out of a map, and puts the mean of their surroundings in their place. A spot is 20 times as
/// bright as the map on average, brings at least 1 % of its light, and fits into a disk of 6 degrees.
std::vector<BrightSpot> take_bright_spots(EnvironmentMap& map);

}  // namespace alvor
