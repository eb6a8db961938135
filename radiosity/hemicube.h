#pragma once
// The hemicube (Cohen & Greenberg 1985).

#include "meshing/vec3.h"

#include <vector>

namespace alvor {

/// Half a cube of half side 1 over a point whose normal is z: a top of resolution x resolution cells and four sides of half as
/// many.
class Hemicube {
 public:
  /// A cell's lower corner, its sides along the face, and its delta form factor: exactly the form factor from the point to the
  /// cell, so that all sum to 1 at any resolution.
  struct Cell {
    Vec3 corner, side_s, side_t;
    double delta = 0;
  };

  /// Requires: resolution even, >= 2.
  explicit Hemicube(int resolution);
  const std::vector<Cell>& cells() const { return cells_; }

 private:
  std::vector<Cell> cells_;
};

}  // namespace alvor
