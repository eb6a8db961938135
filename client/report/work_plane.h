#pragma once
// Grids of points on the work plane of a room (EN 12464-1).

#include "client/report/rooms.h"

#include <optional>
#include <vector>

namespace alvor {

/// Returns the largest distance of grid points on an area of so many metres by metres: 0.2 * 5^log10(d), at most 10 m. d is the
/// longer side, or the shorter one if the longer is at least twice as long. EN 12464-1.
double largest_spacing(double length, double width);

/// A point of a grid, in its column and row.
struct WorkPoint {
  int column = 0, row = 0;
  double along_u = 0, along_v = 0;  ///< of the room's frame, metres
};

/// Points in the middles of equal rectangles that cover the inner rectangle of a room. Points that are not on the room's inner
/// cells are left out.
struct WorkGrid {
  int columns = 0, rows = 0;
  double spacing_u = 0, spacing_v = 0;  ///< metres
  std::vector<WorkPoint> points;        ///< row by row, along v
};

/// `spacing`: the largest distance of points, metres; empty: largest_spacing(). Throws std::length_error if there would be more
/// than 100 000 points.
WorkGrid work_grid(const Room& room, std::optional<double> spacing);

}  // namespace alvor
