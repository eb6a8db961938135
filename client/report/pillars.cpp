#include "client/report/pillars.h"

#include "meshing/disjoint_sets.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr double longest_pillar = 1.5, longest_screen = 6;  // metres
constexpr double most_of_screen = 0.6;                      // m2 of the rectangle about it

/// The walls of a floor as sets of connected corners of its cells: a cell that is no floor connects its four corners, a closed
/// way between two cells the ends of their common side, and the rim of the raster all of its corners.
class WallCorners {
 public:
  explicit WallCorners(const FloorRaster& floor) : floor_(floor), raster_(floor.raster), sets_(corner(0, raster_.rows + 1)) {
    for (int column = 0; column <= raster_.columns; ++column) join(column, 0, 0, 0), join(column, raster_.rows, 0, 0);
    for (int row = 0; row <= raster_.rows; ++row) join(0, row, 0, 0), join(raster_.columns, row, 0, 0);
    for (std::size_t cell = 0; cell < floor.cells.size(); ++cell) add(cell);
    measure();
  }

  /// Returns whether the corner at the lower left of a cell is part of something that stands free.
  bool is_free(int column, int row) {
    const std::size_t set = sets_.find(corner(column, row));
    if (set == sets_.find(0)) return false;
    const double wide = last_u_[set] - first_u_[set], high = last_v_[set] - first_v_[set], length = std::hypot(wide, high);
    return length <= longest_pillar || (length <= longest_screen && wide * high <= most_of_screen);
  }

 private:
  std::uint32_t corner(int column, int row) const { return static_cast<std::uint32_t>(row * (raster_.columns + 1) + column); }
  void join(int column, int row, int to_column, int to_row) { sets_.join(corner(column, row), corner(to_column, to_row)); }

  void add(std::size_t cell) {
    const int column = raster_.column_of(cell), row = raster_.row_of(cell);
    const FloorCell& at = floor_.cells[cell];
    if (!at.is_floor) {
      join(column, row, column + 1, row);
      join(column, row, column, row + 1);
      join(column, row, column + 1, row + 1);
    }
    if (at.closed_to_right) join(column + 1, row, column + 1, row + 1);
    if (at.closed_to_top) join(column, row + 1, column + 1, row + 1);
  }

  void measure() {
    const auto count = corner(0, raster_.rows + 1);
    first_u_.assign(count, 1e300), last_u_.assign(count, -1e300), first_v_.assign(count, 1e300), last_v_.assign(count, -1e300);
    for (int row = 0; row <= raster_.rows; ++row)
      for (int column = 0; column <= raster_.columns; ++column) {
        const std::size_t set = sets_.find(corner(column, row));
        first_u_[set] = std::min(first_u_[set], column * raster_.cell_u);
        last_u_[set] = std::max(last_u_[set], column * raster_.cell_u);
        first_v_[set] = std::min(first_v_[set], row * raster_.cell_v);
        last_v_[set] = std::max(last_v_[set], row * raster_.cell_v);
      }
  }

  const FloorRaster& floor_;
  const PlanRaster& raster_;
  DisjointSets sets_;
  std::vector<double> first_u_, last_u_, first_v_, last_v_;  ///< extent by set
};

}  // namespace

void open_pillars(FloorRaster& floor) {
  WallCorners corners(floor);
  for (std::size_t cell = 0; cell < floor.cells.size(); ++cell) {
    const int column = floor.raster.column_of(cell), row = floor.raster.row_of(cell);
    FloorCell& at = floor.cells[cell];
    if (at.closed_to_right && corners.is_free(column + 1, row)) at.closed_to_right = false;
    if (at.closed_to_top && corners.is_free(column, row + 1)) at.closed_to_top = false;
    if (!at.is_floor && corners.is_free(column, row)) at.is_pillar = true;
  }
}

}  // namespace alvor
