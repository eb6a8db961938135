#include "client/report/floor_raster.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace alvor {

namespace {

constexpr double least_level = 1;     // m2: smaller ones are shelves and sills
constexpr double finest_cell = 0.02;  // metres
constexpr int most_cells_of_side = 1024;
constexpr double wall_height = 1.9;  // metres above the floor: above furniture, below the lintels of doors
constexpr double share_of_low_rooms = 0.8;
constexpr double low_wall = 0.3, below_ceiling = 0.1;  // metres: below a window sill; above a window
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

/// The horizontal triangles of one level.
struct Level {
  double height = 0;
  double area = 0;
  std::vector<std::uint32_t> triangles;
};

/// Returns the levels of a mesh, from the lowest.
std::vector<Level> levels_of(const DisplayMesh& mesh, const PlanFrame& frame) {
  std::vector<std::pair<double, std::uint32_t>> by_height;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 twice = double_area_of(mesh, mesh.triangles[t]);
    if (dot(twice, frame.up) > upright * length(twice))
      by_height.emplace_back(dot(mesh.positions[mesh.triangles[t][0]], frame.up), t);
  }
  std::ranges::sort(by_height);
  std::vector<Level> levels;
  double first = 0;
  for (const auto& [height, triangle] : by_height) {
    if (levels.empty() || height - first > step_height) levels.emplace_back(), first = height;
    const double area = length(double_area_of(mesh, mesh.triangles[triangle])) / 2;
    levels.back().height += area * height;
    levels.back().area += area;
    levels.back().triangles.push_back(triangle);
  }
  for (Level& level : levels) level.height /= level.area;
  std::erase_if(levels, [](const Level& level) { return !(level.area >= least_level); });
  return levels;
}

PlanRaster raster_over(const DisplayMesh& mesh, const Level& level, const PlanFrame& frame) {
  double left = 1e300, right = -1e300, bottom = 1e300, top = -1e300;
  for (const std::uint32_t triangle : level.triangles)
    for (const std::uint32_t vertex : mesh.triangles[triangle]) {
      const double u = dot(mesh.positions[vertex], frame.u), v = dot(mesh.positions[vertex], frame.v);
      left = std::min(left, u), right = std::max(right, u), bottom = std::min(bottom, v), top = std::max(top, v);
    }
  const double side = std::max(finest_cell, std::max(right - left, top - bottom) / most_cells_of_side);
  PlanRaster raster{left, bottom};
  raster.columns = std::max(1, static_cast<int>(std::lround((right - left) / side)));
  raster.rows = std::max(1, static_cast<int>(std::lround((top - bottom) / side)));
  raster.cell_u = (right - left) / raster.columns;
  raster.cell_v = (top - bottom) / raster.rows;
  return raster;
}

/// Fills the cells of one level.
class Survey {
 public:
  Survey(const DisplayMesh& mesh, const TriangleCaster& caster, const PlanFrame& frame)
      : mesh_(mesh), caster_(caster), frame_(frame) {}

  FloorRaster of(const Level& level) const {
    FloorRaster floor{level.height, raster_over(mesh_, level, frame_), {}};
    floor.cells.resize(floor.raster.size());
    std::vector<std::array<std::uint32_t, 3>> triangles;
    for (const std::uint32_t triangle : level.triangles) triangles.push_back(mesh_.triangles[triangle]);
    const TriangleCaster ground(mesh_.positions, triangles, Traversal::watertight);
    for_rows(floor, [&](int column, int row) { survey_floor(floor, level, ground, column, row); });
    const WallHeights heights = heights_of_walls(floor);
    for_rows(floor, [&](int column, int row) { survey_walls(floor, heights, column, row); });
    return floor;
  }

 private:
  template <class Work>
  static void for_rows(const FloorRaster& floor, Work work) {
    tbb::parallel_for(0, floor.raster.rows, [&](int row) {
      for (int column = 0; column < floor.raster.columns; ++column) work(column, row);
    });
  }

  Vec3 place(const FloorRaster& floor, int column, int row, double above) const {
    return frame_.place(floor.raster.middle_u(column), floor.raster.middle_v(row), floor.height + above);
  }

  void survey_floor(FloorRaster& floor, const Level& level, const TriangleCaster& ground, int column, int row) const {
    FloorCell& cell = floor.cells[floor.raster.index(column, row)];
    const auto below = ground.cast(place(floor, column, row, 2 * step_height), -frame_.up);
    if (!below) return;
    cell.triangle = level.triangles[below->triangle];
    const double surface = 2 * step_height - below->distance;
    const auto above = caster_.cast(place(floor, column, row, surface + above_floor), frame_.up);
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

  void survey_walls(FloorRaster& floor, const WallHeights& heights, int column, int row) const {
    FloorCell& cell = floor.cells[floor.raster.index(column, row)];
    cell.is_covered = caster_.cast(place(floor, column, row, heights.wall), frame_.up).has_value();
    const auto is_solid = [&](double height) { return is_in_solid(place(floor, column, row, height)); };
    if (is_wall(heights, is_solid)) cell.is_floor = false;
    const auto is_closed = [&](int to_column, int to_row) {
      return is_wall(heights, [&](double height) {
        return caster_.is_blocked(place(floor, column, row, height), place(floor, to_column, to_row, height));
      });
    };
    if (column + 1 < floor.raster.columns) cell.closed_to_right = is_closed(column + 1, row);
    if (row + 1 < floor.raster.rows) cell.closed_to_top = is_closed(column, row + 1);
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
};

}  // namespace

std::size_t PlanRaster::cell_at(double along_u, double along_v) const {
  const double column = std::floor((along_u - left) / cell_u), row = std::floor((along_v - bottom) / cell_v);
  if (!(column >= 0 && column < columns && row >= 0 && row < rows)) return size();
  return index(static_cast<int>(column), static_cast<int>(row));
}

std::vector<FloorRaster> floor_rasters(const DisplayMesh& mesh, const TriangleCaster& caster, const PlanFrame& frame) {
  const Survey survey(mesh, caster, frame);
  std::vector<FloorRaster> rasters;
  for (const Level& level : levels_of(mesh, frame)) rasters.push_back(survey.of(level));
  return rasters;
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
