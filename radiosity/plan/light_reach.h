#pragma once
// Which faces no light can reach.

#include "meshing/base_mesh.h"
#include "radiosity/plan/point_tree.h"

#include <cstddef>
#include <vector>

namespace alvor {

/// Conservative: a face that any light reaches is never dark.
struct LightReach {
  LightReach(const BaseMesh& mesh, const PointTree& corners);

  std::vector<bool> is_dark;       ///< by root
  std::size_t facing_nothing = 0;  ///< faces in front of which nothing is
  std::size_t shut_off = 0;        ///< others, that sealed rooms keep the light of all emitters from
};

}  // namespace alvor
