#include "client/report/floor_raster.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

/// Replaces each value by the least sum of another one and the square of the way to it, along a line of cells (Felzenszwalb and
/// Huttenlocher 2012, "Distance transforms of sampled functions").
void spread(std::vector<double>& values, double cell) {
  const auto count = static_cast<int>(values.size());
  std::vector<int> at(values.size());
  std::vector<double> from(values.size() + 1), old = values;
  int last = -1;
  const auto meeting = [&](int a, int b) {  // where the parabolas over two places meet
    return ((old[b] - old[a]) / (cell * cell) + double(b) * b - double(a) * a) / (2.0 * (b - a));
  };
  for (int q = 0; q < count; ++q) {
    if (!(old[q] < 1e300)) continue;
    while (last >= 0 && meeting(at[last], q) <= from[last]) --last;
    from[last + 1] = last < 0 ? -1e300 : meeting(at[last], q);
    at[++last] = q;
  }
  for (int q = 0, k = 0; q < count && last >= 0; ++q) {
    while (k < last && from[k + 1] <= q) ++k;
    const double way = (q - at[k]) * cell;
    values[q] = old[at[k]] + way * way;
  }
}

}  // namespace

void measure_edges(FloorRaster& floor) {
  const PlanRaster& raster = floor.raster;
  std::vector<double> squares(raster.size(), 2e300);
  for (std::size_t cell = 0; cell < squares.size(); ++cell)
    if (floor.cells[cell].is_floor && floor.is_at_edge(cell)) squares[cell] = 0;
  std::vector<double> line(static_cast<std::size_t>(raster.columns));
  for (int row = 0; row < raster.rows; ++row) {
    for (int column = 0; column < raster.columns; ++column) line[column] = squares[raster.index(column, row)];
    spread(line, raster.cell_u);
    for (int column = 0; column < raster.columns; ++column) squares[raster.index(column, row)] = line[column];
  }
  line.resize(static_cast<std::size_t>(raster.rows));
  for (int column = 0; column < raster.columns; ++column) {
    for (int row = 0; row < raster.rows; ++row) line[row] = squares[raster.index(column, row)];
    spread(line, raster.cell_v);
    for (int row = 0; row < raster.rows; ++row) squares[raster.index(column, row)] = line[row];
  }
  const double half = std::min(raster.cell_u, raster.cell_v) / 2;
  floor.to_edge.clear();
  for (const double square : squares) floor.to_edge.push_back(static_cast<float>(std::min(1e30, std::sqrt(square) + half)));
}

std::size_t PlanRaster::cell_at(double along_u, double along_v) const {
  const double column = std::floor((along_u - left) / cell_u), row = std::floor((along_v - bottom) / cell_v);
  if (!(column >= 0 && column < columns && row >= 0 && row < rows)) return size();
  return index(static_cast<int>(column), static_cast<int>(row));
}

}  // namespace alvor
