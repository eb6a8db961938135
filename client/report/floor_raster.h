#pragma once
// A horizontal level of a scene as a raster: where it can be walked on, and where walls stand.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace alvor {

/// Cells of equal size over a rectangle of the plan, row by row from the corner (left, bottom).
struct PlanRaster {
  double left = 0, bottom = 0;  ///< along u and v of the frame, metres
  double cell_u = 0, cell_v = 0;
  int columns = 0, rows = 0;

  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
  std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
  }
  int column_of(std::size_t cell) const { return static_cast<int>(cell % static_cast<std::size_t>(columns)); }
  int row_of(std::size_t cell) const { return static_cast<int>(cell / static_cast<std::size_t>(columns)); }
  double middle_u(int column) const { return left + (column + 0.5) * cell_u; }
  double middle_v(int row) const { return bottom + (row + 0.5) * cell_v; }
  /// Calls visit(cell) for the up to four neighbours of a cell.
  template <class Visit>
  void for_neighbours(std::size_t cell, Visit visit) const {
    const int column = column_of(cell), row = row_of(cell);
    if (column + 1 < columns) visit(cell + 1);
    if (column > 0) visit(cell - 1);
    if (row + 1 < rows) visit(cell + static_cast<std::size_t>(columns));
    if (row > 0) visit(cell - static_cast<std::size_t>(columns));
  }
  /// Returns the cell in which a place lies; size() if it lies in none.
  std::size_t cell_at(double along_u, double along_v) const;
};

/// One cell of a level: its floor, what stands on it, and the walls around it.
struct FloorCell {
  bool is_floor = false;         ///< the level is there, and no wall stands on it
  bool is_covered = false;       ///< something is above it, higher than furniture
  bool is_pillar = false;        ///< something stands on it that is no part of a wall: it is small, with floor all around
  bool closed_to_right = false;  ///< a wall separates it from the next cell along u
  bool closed_to_top = false;    ///< and along v
  float surface = 0;             ///< of the floor above the level's height, metres
  float wall_height = 0;         ///< above the surface, at which walls were looked for, metres
  float clear_height = std::numeric_limits<float>::infinity();  ///< to what is above the floor, metres
  std::uint32_t triangle = 0;                                   ///< of the mesh, on which the middle of the cell lies
};

/// One level: all horizontal faces that face up within `step_height` of each other.
struct FloorRaster {
  double height = 0;  ///< along up, metres
  PlanRaster raster;
  std::vector<FloorCell> cells;
  std::vector<float> to_edge;  ///< by cell: metres to the nearest wall or end of the floor; see measure_edges()

  /// Returns whether a cell of the floor lies beside a wall or the floor's end.
  bool is_at_edge(std::size_t cell) const {
    int neighbours = 0;
    for_open_neighbours(cell, [&](std::size_t next) { neighbours += cells[next].is_floor || cells[next].is_pillar; });
    return neighbours < 4;
  }

  /// Calls visit(cell) for the neighbours of a cell that no wall separates from it, floor or not.
  template <class Visit>
  void for_open_neighbours(std::size_t cell, Visit visit) const {
    raster.for_neighbours(cell, [&](std::size_t next) {
      const std::size_t first = std::min(cell, next);
      const bool is_in_row = std::max(cell, next) == first + 1 && raster.row_of(cell) == raster.row_of(next);
      if (!(is_in_row ? cells[first].closed_to_right : cells[first].closed_to_top)) visit(next);
    });
  }
};

/// Sets the distances of a floor's cells to its edges.
void measure_edges(FloorRaster& floor);

}  // namespace alvor
