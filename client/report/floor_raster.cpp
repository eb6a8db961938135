#include "client/report/floor_raster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace alvor {

namespace {

constexpr double least_level = 1;     // m2: smaller ones are shelves and sills
constexpr double finest_cell = 0.02;  // metres
constexpr int most_cells_of_side = 1024;
constexpr double wall_height = 1.9;  // metres above the floor: above furniture, below the lintels of doors
constexpr double share_of_low_rooms = 0.8;
constexpr double low_wall = 0.3, below_ceiling = 0.1;  // metres: below a window sill; above a window
constexpr double least_under_roof = 0.9;               // metres: lower places under a roof are no floor
constexpr double above_floor = 1e-3;                   // metres: where rays begin
constexpr double upright = 0.999, vertical = 0.1;      // of the part of a unit normal that points up

Vec3 double_area_of(const DisplayMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Vec3 a = mesh.positions[triangle[0]];
  return cross(mesh.positions[triangle[1]] - a, mesh.positions[triangle[2]] - a);
}

/// The direction of a wall's normal on the plan, up to quarters of a turn, and its area.
struct WallDirection {
  double angle, area;
};

constexpr double quarter_turn = std::numbers::pi / 2, even = 0.01;  // radians

/// Returns an angle that differs by quarters of a turn, in [-pi / 4, pi / 4).
double within_quarter(double angle) { return angle - quarter_turn * std::floor(angle / quarter_turn + 0.5); }

/// Returns the angle about which the largest area of walls lies within `even`; 0 without walls.
double main_direction(std::vector<WallDirection> walls) {
  std::ranges::sort(walls, {}, &WallDirection::angle);
  const std::size_t count = walls.size();
  for (std::size_t n = 0; n < count; ++n)  // once more, a quarter of a turn on
    walls.push_back({walls[n].angle + quarter_turn, walls[n].area});
  double best = 0, most = 0, area = 0, moment = 0;
  for (std::size_t first = 0, end = 0; first < count; ++first) {
    for (; end < walls.size() && walls[end].angle - walls[first].angle <= 2 * even; ++end)
      area += walls[end].area, moment += walls[end].area * walls[end].angle;
    constexpr double rounding = 1e-9;  // of sums, so that equal areas count as equal
    if (area > (1 + rounding) * most) most = area, best = within_quarter(moment / area);
    area -= walls[first].area, moment -= walls[first].area * walls[first].angle;
  }
  constexpr double nothing = 1e-6;
  return std::abs(best) > nothing ? best : 0;
}

/// A rectangle of the plan.
struct PlanBox {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;

  void add(double u, double v) {
    left = std::min(left, u), right = std::max(right, u), bottom = std::min(bottom, v), top = std::max(top, v);
  }
  bool is_empty() const { return !(left < right && bottom < top); }
};

PlanBox box_of(const DisplayMesh& mesh, const FloorLevel& level, const PlanFrame& frame) {
  PlanBox box;
  for (const std::uint32_t triangle : level.triangles)
    for (const std::uint32_t vertex : mesh.triangles[triangle])
      box.add(dot(mesh.positions[vertex], frame.u), dot(mesh.positions[vertex], frame.v));
  return box;
}

/// Returns the part of a level's box that lies under or beside something that is higher: ground far around a house takes no
/// cells.
PlanBox built_part(const DisplayMesh& mesh, const FloorLevel& level, const PlanFrame& frame) {
  constexpr double higher = 0.3, around = 1;  // metres
  PlanBox built;
  for (const auto& triangle : mesh.triangles) {
    const auto is_higher = [&](std::uint32_t vertex) { return dot(mesh.positions[vertex], frame.up) > level.height + higher; };
    if (!std::ranges::any_of(triangle, is_higher)) continue;
    for (const std::uint32_t vertex : triangle)
      built.add(dot(mesh.positions[vertex], frame.u), dot(mesh.positions[vertex], frame.v));
  }
  const PlanBox all = box_of(mesh, level, frame);
  const PlanBox part{std::max(all.left, built.left - around), std::min(all.right, built.right + around),
                     std::max(all.bottom, built.bottom - around), std::min(all.top, built.top + around)};
  return part.is_empty() ? all : part;
}

PlanRaster raster_over(const PlanBox& box) {
  const double wide = box.right - box.left, high = box.top - box.bottom;
  const double side = std::max(finest_cell, std::max(wide, high) / most_cells_of_side);
  PlanRaster raster{box.left, box.bottom};
  raster.columns = std::max(1, static_cast<int>(std::lround(wide / side)));
  raster.rows = std::max(1, static_cast<int>(std::lround(high / side)));
  raster.cell_u = wide / raster.columns;
  raster.cell_v = high / raster.rows;
  return raster;
}

/// Fills the cells of one level.
class Survey {
 public:
  Survey(const DisplayMesh& mesh, const TriangleCaster& caster, const PlanFrame& frame, const FloorLevel& level)
      : mesh_(mesh),
        caster_(caster),
        frame_(frame),
        level_(level),
        ground_(mesh.positions, triangles_of(mesh, level), Traversal::watertight) {}

  FloorRaster over(const PlanBox& box) const {
    FloorRaster floor{level_.height, raster_over(box), {}, {}};
    floor.cells.resize(floor.raster.size());
    for_rows(floor, [&](int column, int row) { survey_floor(floor, column, row); });
    const WallHeights heights = heights_of_walls(floor);
    for_rows(floor, [&](int column, int row) { survey_cell(floor, heights, column, row); });
    for_rows(floor, [&](int column, int row) { survey_ways(floor, heights, column, row); });
    return floor;
  }

 private:
  static std::vector<std::array<std::uint32_t, 3>> triangles_of(const DisplayMesh& mesh, const FloorLevel& level) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const std::uint32_t triangle : level.triangles) triangles.push_back(mesh.triangles[triangle]);
    return triangles;
  }

  template <class Work>
  static void for_rows(const FloorRaster& floor, Work work) {
    tbb::parallel_for(0, floor.raster.rows, [&](int row) {
      for (int column = 0; column < floor.raster.columns; ++column) work(column, row);
    });
  }

  /// Returns a place over the middle of a cell; `above` counts from the cell's own surface.
  Vec3 place(const FloorRaster& floor, std::size_t cell, double above) const {
    const PlanRaster& raster = floor.raster;
    return frame_.place(raster.middle_u(raster.column_of(cell)), raster.middle_v(raster.row_of(cell)),
                        floor.height + floor.cells[cell].surface + above);
  }

  void survey_floor(FloorRaster& floor, int column, int row) const {
    const std::size_t index = floor.raster.index(column, row);
    FloorCell& cell = floor.cells[index];
    const auto below = ground_.cast(place(floor, index, 2 * step_height), -frame_.up);
    if (!below) return;
    cell.triangle = level_.triangles[below->triangle];
    cell.surface = static_cast<float>(2 * step_height - below->distance);
    const auto above = caster_.cast(place(floor, index, above_floor), frame_.up);
    if (above) cell.clear_height = static_cast<float>(above->distance + above_floor);
    cell.is_floor = true;
  }

  /// Heights above a level at which walls are looked for: what is there at `wall`, or both near the floor and near the ceiling,
  /// as below and above a window.
  struct WallHeights {
    double low, wall, high;
  };

  /// Furniture makes some clear heights small.
  WallHeights heights_of_walls(const FloorRaster& floor) const {
    std::vector<float> heights;
    for (const FloorCell& cell : floor.cells)
      if (cell.is_floor && std::isfinite(cell.clear_height)) heights.push_back(cell.clear_height);
    if (heights.empty()) return {low_wall, wall_height, wall_height};
    const auto high = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() * 9 / 10);
    std::ranges::nth_element(heights, high);
    const double wall = std::min(wall_height, share_of_low_rooms * *high);
    return {std::min(low_wall, wall / 2), wall, std::max(wall, *high - below_ceiling)};
  }

  void survey_cell(FloorRaster& floor, const WallHeights& heights, int column, int row) const {
    const std::size_t index = floor.raster.index(column, row);
    FloorCell& cell = floor.cells[index];
    if (!cell.is_floor) return;
    cell.wall_height = static_cast<float>(heights.wall);
    const auto is_solid = [&](double height) { return is_in_solid(place(floor, index, height)); };
    const auto is_covered = [&](double height) { return caster_.cast(place(floor, index, height), frame_.up).has_value(); };
    cell.is_covered = is_covered(heights.wall);
    const bool is_wall_there = is_wall(heights, is_solid);
    if (!is_wall_there && cell.is_covered) return;
    // Under a sloping roof, that height lies above the roof or within it.
    const double lower = share_of_low_rooms * cell.clear_height;
    const bool is_under_roof = cell.clear_height >= least_under_roof && lower < heights.wall && !is_solid(lower);
    if (is_under_roof) cell.wall_height = static_cast<float>(lower), cell.is_covered = true;
    cell.is_floor = is_under_roof || !is_wall_there;
  }

  void survey_ways(FloorRaster& floor, const WallHeights& heights, int column, int row) const {
    const std::size_t index = floor.raster.index(column, row);
    FloorCell& cell = floor.cells[index];
    if (column + 1 < floor.raster.columns) cell.closed_to_right = is_closed(floor, heights, index, index + 1);
    if (row + 1 < floor.raster.rows)
      cell.closed_to_top = is_closed(floor, heights, index, index + static_cast<std::size_t>(floor.raster.columns));
  }

  bool is_closed(const FloorRaster& floor, const WallHeights& heights, std::size_t from, std::size_t to) const {
    if (!floor.cells[from].is_floor || !floor.cells[to].is_floor) return false;  // nobody goes there
    const double wall = std::min(floor.cells[from].wall_height, floor.cells[to].wall_height);
    return is_wall({heights.low, wall, heights.high},
                   [&](double height) { return caster_.is_blocked(place(floor, from, height), place(floor, to, height)); });
  }

  template <class IsThere>
  static bool is_wall(const WallHeights& heights, IsThere is_there) {
    return is_there(heights.wall) || (is_there(heights.low) && is_there(heights.high));
  }

  /// Returns whether a point sees more backs of surfaces around it than fronts. Faces of solids that touch lie in one
  /// place, so that some rays meet a front from inside.
  bool is_in_solid(Vec3 point) const {
    constexpr int directions = 8;
    int backs = 0, fronts = 0;
    for (int n = 0; n < directions; ++n) {
      const double angle = 2 * std::numbers::pi * (n + 0.4) / directions;
      const Vec3 direction = std::cos(angle) * frame_.u + std::sin(angle) * frame_.v;
      if (const auto hit = caster_.cast(point, direction))
        ++(dot(double_area_of(mesh_, mesh_.triangles[hit->triangle]), direction) > 0 ? backs : fronts);
    }
    return backs > fronts;
  }

  const DisplayMesh& mesh_;
  const TriangleCaster& caster_;
  const PlanFrame& frame_;
  const FloorLevel& level_;
  const TriangleCaster ground_;
};

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

/// One level at hand: its triangles, and what surveys them.
struct FloorSurvey::State {
  FloorLevel level;
  PlanBox built;
  Survey survey;
  State(const DisplayMesh& mesh, const TriangleCaster& caster, const PlanFrame& frame, FloorLevel given)
      : level(std::move(given)), built(built_part(mesh, level, frame)), survey(mesh, caster, frame, level) {}
};

FloorSurvey::FloorSurvey(const DisplayMesh& mesh, const TriangleCaster& caster, const PlanFrame& frame, FloorLevel level)
    : state_(new State(mesh, caster, frame, std::move(level))) {}
FloorSurvey::~FloorSurvey() = default;

FloorRaster FloorSurvey::coarse() const { return state_->survey.over(state_->built); }

FloorRaster FloorSurvey::fine(const PlanRaster& around) const {
  constexpr double margin = 0.3;  // metres: the walls, and a little of what is behind them
  return state_->survey.over({around.left - margin, around.left + around.columns * around.cell_u + margin, around.bottom - margin,
                              around.bottom + around.rows * around.cell_v + margin});
}

std::vector<FloorLevel> floor_levels(const DisplayMesh& mesh, const PlanFrame& frame) {
  std::vector<std::pair<double, std::uint32_t>> by_height;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 twice = double_area_of(mesh, mesh.triangles[t]);
    if (dot(twice, frame.up) > upright * length(twice))
      by_height.emplace_back(dot(mesh.positions[mesh.triangles[t][0]], frame.up), t);
  }
  std::ranges::sort(by_height);
  std::vector<FloorLevel> levels;
  double first = 0;
  for (const auto& [height, triangle] : by_height) {
    if (levels.empty() || height - first > step_height) levels.emplace_back(), first = height;
    const double area = length(double_area_of(mesh, mesh.triangles[triangle])) / 2;
    levels.back().height += area * height;
    levels.back().area += area;
    levels.back().triangles.push_back(triangle);
  }
  for (FloorLevel& level : levels) level.height /= level.area;
  std::erase_if(levels, [](const FloorLevel& level) { return !(level.area >= least_level); });
  return levels;
}

PlanFrame frame_along_walls(const DisplayMesh& mesh) {
  const PlanFrame frame = plan_frame(mesh.up, 0);
  std::vector<WallDirection> walls;
  for (const auto& triangle : mesh.triangles) {
    const Vec3 twice = double_area_of(mesh, triangle);
    const double area = length(twice);
    if (area > 0 && std::abs(dot(twice, frame.up)) < vertical * area)
      walls.push_back({within_quarter(std::atan2(dot(twice, frame.v), dot(twice, frame.u))), area});
  }
  return plan_frame(mesh.up, main_direction(std::move(walls)));
}

}  // namespace alvor
