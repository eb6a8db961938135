#include "client/report/rooms.h"

#include "meshing/face_object.h"
#include "client/report/floor_survey.h"
#include "client/report/pillars.h"
#include "client/report/room_division.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <map>
#include <stdexcept>

namespace alvor {

namespace {

double height_of(const DisplayMesh& mesh, const PlanFrame& frame) {
  double low = 1e300, high = -1e300;
  for (const Vec3& position : mesh.positions) {
    low = std::min(low, dot(position, frame.up));
    high = std::max(high, dot(position, frame.up));
  }
  return high - low;
}

/// Returns the name of the object that a triangle belongs to; nothing if that is not known.
std::string object_of_triangle(const DisplayMesh& mesh, std::uint32_t triangle) {
  std::uint64_t end = 0;
  for (const FaceTriangles& run : mesh.faces) {
    end += run.count;
    if (triangle >= end) continue;
    const auto object = object_of_face(mesh.objects, run.faces.first);
    return object ? mesh.objects[*object].name : std::string();
  }
  return {};
}

void name_rooms(const DisplayMesh& mesh, std::vector<Room>& rooms) {
  std::map<std::string, int> times;
  for (Room& room : rooms) {
    room.name = object_of_triangle(mesh, room.floor_triangle);
    for (char& c : room.name)
      if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
    ++times[room.name];
  }
  std::map<std::string, int> number;
  for (Room& room : rooms) {
    const std::string name = room.name;
    if (name.empty() || times[name] > 1) room.name = (name.empty() ? "Room" : name) + " " + std::to_string(++number[name]);
  }
}

/// Returns whether cells are small enough for areas and borders.
bool is_fine(const PlanRaster& raster) {
  constexpr double fine_cell = 0.06;  // metres
  return std::max(raster.cell_u, raster.cell_v) <= fine_cell;
}

/// Returns whether a room of a fine raster is that of a coarse one: most of its cells lie there.
bool is_same_room(const Room& fine, const Room& coarse) {
  std::size_t all = 0, there = 0;
  for (std::size_t cell = 0; cell < fine.cells.size(); ++cell) {
    if (fine.cells[cell] == Room::Cell::elsewhere) continue;
    ++all;
    there += coarse.cell_at(fine.raster.middle_u(fine.raster.column_of(cell)), fine.raster.middle_v(fine.raster.row_of(cell))) !=
             Room::Cell::elsewhere;
  }
  return 2 * there > all;
}

/// Throws std::length_error if a room is so high that its scene counts in centimetres or millimetres.
void require_sensible_height(const Room& room) {
  constexpr double highest = 100;  // metres: higher than halls and domes
  if (!std::isfinite(room.clear_height) || room.clear_height <= highest) return;
  char height[32];
  std::snprintf(height, sizeof height, "%.3g", room.clear_height);
  throw std::length_error("a room is " + std::string(height) +
                          " m high: does the scene count in centimetres or millimetres? Its unit has to be the metre");
}

/// Returns the rooms of a level; those found on a coarse raster are surveyed once more.
std::vector<Room> rooms_of_level(const FloorSurvey& survey, const PlanFrame& frame, const RoomLimits& limits,
                                 std::span<const Room> below) {
  const auto rooms_in = [&](FloorRaster floor) {
    open_pillars(floor);
    measure_edges(floor);
    return rooms_on(floor, frame, limits, below);
  };
  std::vector<Room> rooms;
  for (Room& room : rooms_in(survey.coarse())) {
    require_sensible_height(room);
    if (is_fine(room.raster)) {
      rooms.push_back(std::move(room));
      continue;
    }
    for (Room& finer : rooms_in(survey.fine(room.raster)))
      if (is_same_room(finer, room)) rooms.push_back(std::move(finer));
  }
  return rooms;
}

}  // namespace

std::optional<std::size_t> room_at(std::span<const Room> rooms, Vec3 place) {
  constexpr double above_ceiling = 0.5;  // metres
  std::optional<std::size_t> found;
  for (std::size_t n = 0; n < rooms.size(); ++n) {
    const Room& room = rooms[n];
    const double u = dot(place, room.frame.u), v = dot(place, room.frame.v),
                 height = dot(place, room.frame.up) - room.floor_at(u, v);
    const bool is_here = height > 0 && height < room.clear_height + above_ceiling && room.cell_at(u, v) != Room::Cell::elsewhere;
    if (is_here && (!found || room.floor_height > rooms[*found].floor_height)) found = n;
  }
  return found;
}

std::vector<Room> rooms_of(const DisplayMesh& mesh, double border) {
  const TriangleCaster caster(mesh.positions, mesh.triangles, Traversal::watertight);
  const PlanFrame frame = frame_along_walls(mesh);
  RoomLimits limits{border};
  limits.least_clear = std::min(limits.least_clear, height_of(mesh, frame) / 2);
  const std::vector<FloorLevel> levels = floor_levels(mesh, frame);
  std::vector<Room> rooms;
  for (const bool needs_ceiling : {true, false}) {
    if (!rooms.empty()) break;
    limits.needs_ceiling = needs_ceiling;
    for (const FloorLevel& level : levels) {
      std::vector<Room> found = rooms_of_level(FloorSurvey(mesh, caster, frame, level), frame, limits, rooms);
      rooms.insert(rooms.end(), std::move_iterator(found.begin()), std::move_iterator(found.end()));
    }
  }
  name_rooms(mesh, rooms);
  return rooms;
}

}  // namespace alvor
