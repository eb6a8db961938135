#pragma once
// Finds the rooms of a solution: connected floors between walls.

#include "client/report/floor_raster.h"
#include "client/report/plan_frame.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// A floor between walls, and the part of it on which illuminance is assessed.
struct Room {
  /// A cell of the plan.
  enum class Cell : std::uint8_t { elsewhere, border, inner };

  std::string name;  ///< of the object that has the floor, with a number where several rooms have it; else "Room 1"
  std::uint32_t floor_triangle = 0;  ///< of the mesh: one of the floor's
  PlanFrame frame;
  double floor_height = 0;     ///< along up, metres: the median
  double clear_height = 0;     ///< to what is above the floor, where it is highest (10 % of it); infinite under the open sky
  PlanRaster raster;           ///< the plan around the room
  std::vector<Cell> cells;     ///< of the raster: outside of the room, nearer to a wall than the border, farther
  std::vector<float> surface;  ///< of each cell: height of its floor above floor_height, metres
  double local_width = 0;      ///< diameter of the largest circle on the floor, at most its shorter side, metres
  double area = 0;             ///< m2, of the floor between the walls
  double left = 0, bottom = 0, length = 0, width = 0;  ///< rectangle about the inner cells, along u and v of the frame, metres

  Cell cell_at(double along_u, double along_v) const {
    const std::size_t cell = raster.cell_at(along_u, along_v);
    return cell < cells.size() ? cells[cell] : Cell::elsewhere;
  }
  /// Returns the height of the floor at a place, along up.
  double floor_at(double along_u, double along_v) const {
    const std::size_t cell = raster.cell_at(along_u, along_v);
    return floor_height + (cell < surface.size() ? surface[cell] : 0);
  }
};

/// Returns the number of the room in which a place lies: the one with the highest floor below it. Places up to half a metre above
/// the ceiling count, for recessed luminaires.
std::optional<std::size_t> room_at(std::span<const Room> rooms, Vec3 place);

/// Returns the rooms, lowest first. What is nearer to a wall than `border` (metres), but at most 15 % of a floor's shorter side,
/// is not assessed. Floors joined by a door, up to 1.3 m wide, are two rooms. Tops of furniture are no floors. Where nothing has
/// a ceiling, open floors are rooms. Throws std::length_error if a room is more than 100 m high.
std::vector<Room> rooms_of(const DisplayMesh& mesh, double border);

}  // namespace alvor
