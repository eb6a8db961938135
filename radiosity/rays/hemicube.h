#pragma once
// The hemicube (Cohen & Greenberg 1985).

#include "meshing/vec3.h"

#include <vector>

namespace alvor {

/// How a hemicube's faces are cut into cells.
struct HemicubeGrid {
  int top_s = 0, top_t = 0;         ///< across the top
  int side_along = 0, side_up = 0;  ///< across each of the four sides

  int cell_count() const { return top_s * top_t + 4 * side_along * side_up; }
  /// Square cells. Requires: resolution even, >= 2.
  static HemicubeGrid square(int resolution) { return {resolution, resolution, resolution, resolution / 2}; }
};

/// Half a cube of half side 1 over a point whose normal is z.
class Hemicube {
 public:
  /// A cell's lower corner, its sides along the face, and its delta form factor: exactly the form factor from the point to the
  /// cell, so that all sum to 1 whatever the grid.
  struct Cell {
    Vec3 corner, side_s, side_t;
    double delta = 0;
  };

  /// Requires: all numbers >= 1.
  explicit Hemicube(const HemicubeGrid& grid);
  const std::vector<Cell>& cells() const { return cells_; }

 private:
  std::vector<Cell> cells_;
};

}  // namespace alvor
