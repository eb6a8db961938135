#pragma once
// Finds the faces that no light can reach.

#include "meshing/base_mesh.h"
#include "radiosity/plan/point_tree.h"

#include <cstddef>
#include <vector>

namespace alvor {

/// The faces whose fronts no light can reach. A face that any light reaches is never counted as dark; a dark face may be missed.
struct LightReach {
  /// `corners` holds the corners of all roots that are there and the places of all lamps, relative to the mesh's centre.
  LightReach(const BaseMesh& mesh, const PointTree& corners);

  std::vector<bool> is_dark;       ///< by root
  std::size_t facing_nothing = 0;  ///< faces with nothing in front of them
  std::size_t shut_off = 0;        ///< other faces, which sealed rooms shut off from the light of all emitters
  std::size_t hidden = 0;          ///< other faces, which are not there
};

}  // namespace alvor
