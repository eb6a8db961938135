#pragma once

#include "meshing/patch_forest.h"

#include <span>
#include <vector>

namespace alvor {

/// A way to make the solution better, and where. Patches are nodes of the forest of leaves for split_leaf, of that of rows
/// otherwise.
struct Candidate {
  enum class Kind { split_leaf, split_row, add_rays };
  Kind kind = Kind::split_leaf;
  NodeIndex patch = 0;
  double squared_error = 0;  ///< what it would remove most of, area-weighted
  double rays = 1;           ///< what it costs
};

/// The candidates with the most error per ray that together make up `share` of the whole squared error (bulk marking, Doerfler
/// 1996).
std::vector<Candidate> mark(std::vector<Candidate> candidates, double share);

}  // namespace alvor
