#include "client/report/work_plane.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace alvor {

namespace {

constexpr double most_points = 1e5, most_spacing = 10, rounding = 1e-9;

}  // namespace

double largest_spacing(double length, double width) {
  const double longer = std::max(length, width), shorter = std::min(length, width);
  const double d = longer >= 2 * shorter ? shorter : longer;
  return std::min(most_spacing, 0.2 * std::pow(5, std::log10(d)));
}

WorkGrid work_grid(const Room& room, std::optional<double> spacing) {
  const double most =
      spacing.value_or(largest_spacing(std::max(room.length, room.width), std::min({room.length, room.width, room.local_width})));
  const double columns = std::max(1.0, std::ceil(room.length / most - rounding)),
               rows = std::max(1.0, std::ceil(room.width / most - rounding));
  if (columns * rows > most_points) throw std::length_error("more than 100000 grid points");
  WorkGrid grid{static_cast<int>(columns), static_cast<int>(rows), room.length / columns, room.width / rows, {}};
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const double u = room.left + (column + 0.5) * grid.spacing_u, v = room.bottom + (row + 0.5) * grid.spacing_v;
      if (room.cell_at(u, v) == Room::Cell::inner) grid.points.push_back({column, row, u, v});
    }
  return grid;
}

}  // namespace alvor
