#include "client/report/plan_frame.h"

#include "meshing/mesh_area.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace alvor {

namespace {

constexpr double upright_part = 0.1;  // of a wall's unit normal, at most

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

}  // namespace

PlanFrame frame_along_walls(const DisplayMesh& mesh) {
  const PlanFrame frame = plan_frame(mesh.up, 0);
  std::vector<WallDirection> walls;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 twice = double_area_of(mesh, t);
    const double area = length(twice);
    if (area > 0 && std::abs(dot(twice, frame.up)) < upright_part * area)
      walls.push_back({within_quarter(std::atan2(dot(twice, frame.v), dot(twice, frame.u))), area});
  }
  return plan_frame(mesh.up, main_direction(std::move(walls)));
}

}  // namespace alvor
