#include "client/report/floor_survey.h"

#include "meshing/mesh_area.h"

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
constexpr double upright = 0.999;                      // of the part of a unit normal that points up

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
        ++(dot(double_area_of(mesh_, hit->triangle), direction) > 0 ? backs : fronts);
    }
    return backs > fronts;
  }

  const DisplayMesh& mesh_;
  const TriangleCaster& caster_;
  const PlanFrame& frame_;
  const FloorLevel& level_;
  const TriangleCaster ground_;
};

}  // namespace

struct FloorSurvey::State {
  PlanBox built;
  Survey survey;
};

FloorSurvey::FloorSurvey(const DisplayMesh& mesh, const TriangleCaster& caster, const PlanFrame& frame, const FloorLevel& level)
    : state_(new State{built_part(mesh, level, frame), Survey(mesh, caster, frame, level)}) {}
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
    const Vec3 twice = double_area_of(mesh, t);
    if (dot(twice, frame.up) > upright * length(twice))
      by_height.emplace_back(dot(mesh.positions[mesh.triangles[t][0]], frame.up), t);
  }
  std::ranges::sort(by_height);
  std::vector<FloorLevel> levels;
  double first = 0;
  for (const auto& [height, triangle] : by_height) {
    if (levels.empty() || height - first > step_height) levels.emplace_back(), first = height;
    const double area = area_of(mesh, triangle);
    levels.back().height += area * height;
    levels.back().area += area;
    levels.back().triangles.push_back(triangle);
  }
  for (FloorLevel& level : levels) level.height /= level.area;
  std::erase_if(levels, [](const FloorLevel& level) { return !(level.area >= least_level); });
  return levels;
}

}  // namespace alvor
