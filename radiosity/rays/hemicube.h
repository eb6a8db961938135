#pragma once
// The hemicube (Cohen & Greenberg 1985).

#include "meshing/vec3.h"

#include <cassert>
#include <vector>

namespace alvor {

/// The numbers of cells into which a hemicube's five faces are cut.
struct HemicubeGrid {
  int top_s = 0, top_t = 0;         ///< cells across the top, in its two directions
  int side_along = 0, side_up = 0;  ///< cells of each of the four sides: along its lower edge, and upwards

  int cell_count() const { return top_s * top_t + 4 * side_along * side_up; }
  /// Returns a grid of square cells, `resolution` along each edge of the top. Requires: resolution even, >= 2.
  static HemicubeGrid square(int resolution) {
    assert(resolution >= 2 && resolution % 2 == 0);
    return {resolution, resolution, resolution, resolution / 2};
  }
};

/// The upper half of a cube of side 2 centred at a point whose normal is z.
class Hemicube {
 public:
  /// A cell: its lower corner, its sides along the face, and its delta form factor, which is the exact form factor from the point
  /// to the cell. The delta form factors of all cells sum to 1 for every grid.
  struct Cell {
    Vec3 corner, side_s, side_t;
    double delta = 0;
  };

  /// Requires: all numbers of `grid` >= 1.
  explicit Hemicube(const HemicubeGrid& grid);
  const std::vector<Cell>& cells() const { return cells_; }

 private:
  std::vector<Cell> cells_;
};

}  // namespace alvor
