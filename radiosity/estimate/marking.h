#pragma once

#include "meshing/patch_forest.h"

#include <span>
#include <vector>

namespace alvor {

/// One possible refinement of the solution. `patch` is a node of the leaf forest if refines_leaf(), and of the row forest
/// otherwise.
struct Candidate {
  enum class Kind { split_leaf, add_shadow_rays, split_row, add_rays };
  Kind kind = Kind::split_leaf;
  NodeIndex patch = 0;
  double squared_error = 0;       ///< squared error, integrated over the patch, most of which the refinement would remove
  double rays = 1;                ///< rays that the refinement costs
  Split split = Split::quarters;  ///< how it splits the patch, if it does and limits allow it

  bool refines_leaf() const { return kind == Kind::split_leaf || kind == Kind::add_shadow_rays; }
  bool splits() const { return kind == Kind::split_leaf || kind == Kind::split_row; }
};

/// Returns the candidates with the most squared error per ray that together make up `share` of the whole squared error (bulk
/// marking, Doerfler 1996), the best first.
std::vector<Candidate> mark(std::vector<Candidate> candidates, double share);

}  // namespace alvor
