#include "client/report/room_division.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>

namespace alvor {

namespace {

constexpr double least_core = 0.2, least_area = 1;     // m2
constexpr double half_door = 0.65, least_width = 0.8;  // metres
constexpr double least_share_clear = 0.2;              // of a floor's cells
constexpr double most_border = 0.15;                   // of the shorter side
constexpr double height_of_furniture = 1.8;            // metres: a level that is higher above a floor is an upper floor
constexpr std::uint32_t none = 0xffffffff;

/// Returns the number of each cell's part, counted from 0: parts are connected cells for which `belongs`.
template <class Belongs>
std::vector<std::uint32_t> parts_of(const FloorRaster& floor, std::uint32_t& count, Belongs belongs) {
  std::vector<std::uint32_t> parts(floor.cells.size(), none);
  std::vector<std::size_t> open;
  count = 0;
  for (std::size_t start = 0; start < parts.size(); ++start) {
    if (parts[start] != none || !belongs(start)) continue;
    parts[start] = count;
    open.push_back(start);
    while (!open.empty()) {
      const std::size_t cell = open.back();
      open.pop_back();
      floor.for_open_neighbours(cell, [&](std::size_t next) {
        if (parts[next] != none || !belongs(next)) return;
        parts[next] = count;
        open.push_back(next);
      });
    }
    ++count;
  }
  return parts;
}

/// The cells of one part of a floor.
struct Part {
  std::vector<std::size_t> cells;
  int first_column = 0, last_column = -1, first_row = 0, last_row = -1;
};

Part part_of(const PlanRaster& raster, std::vector<std::size_t> cells) {
  Part part{std::move(cells)};
  part.first_column = raster.columns, part.first_row = raster.rows;
  for (const std::size_t cell : part.cells) {
    part.first_column = std::min(part.first_column, raster.column_of(cell));
    part.last_column = std::max(part.last_column, raster.column_of(cell));
    part.first_row = std::min(part.first_row, raster.row_of(cell));
    part.last_row = std::max(part.last_row, raster.row_of(cell));
  }
  return part;
}

std::vector<Part> collected(const PlanRaster& raster, std::span<const std::uint32_t> numbers, std::uint32_t count) {
  std::vector<std::vector<std::size_t>> cells(count);
  for (std::size_t cell = 0; cell < numbers.size(); ++cell)
    if (numbers[cell] != none) cells[numbers[cell]].push_back(cell);
  std::vector<Part> parts;
  for (auto& each : cells) parts.push_back(part_of(raster, std::move(each)));
  return parts;
}

/// Returns whether most of a part has something above it.
bool is_covered(const FloorRaster& floor, const Part& part) {
  const auto covered = std::ranges::count_if(part.cells, [&](std::size_t cell) { return floor.cells[cell].is_covered; });
  return 2 * static_cast<std::size_t>(covered) >= part.cells.size();
}

/// Returns the clear height that a share of a part's cells exceeds.
double height_of_share(const FloorRaster& floor, const Part& part, double share) {
  std::vector<float> heights;
  const bool is_roofed = is_covered(floor, part);
  for (const std::size_t cell : part.cells)
    if (!is_roofed || floor.cells[cell].is_covered) heights.push_back(floor.cells[cell].clear_height);
  const auto place = heights.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(heights.size() - 1));
  std::ranges::nth_element(heights, place, std::greater{});
  return *place;
}

/// Finds the rooms of one level.
class LevelRooms {
 public:
  LevelRooms(const FloorRaster& floor, const PlanFrame& frame, const RoomLimits& limits)
      : floor_(floor), raster_(floor.raster), frame_(frame), limits_(limits) {}

  /// Returns the rooms that do not stand on those `below`.
  std::vector<Room> rooms_above(std::span<const Room> below) const {
    std::uint32_t count = 0;
    const auto numbers = parts_of(floor_, count, [&](std::size_t cell) { return floor_.cells[cell].is_floor; });
    std::vector<Room> rooms;
    for (const Part& part : collected(raster_, numbers, count))
      if (is_floor(part, below)) add_rooms_of(part, rooms);
    return rooms;
  }

 private:
  double cell_area() const { return raster_.cell_u * raster_.cell_v; }

  bool is_floor(const Part& part, std::span<const Room> below) const {
    if (static_cast<double>(part.cells.size()) * cell_area() < least_area) return false;
    if (height_of_share(floor_, part, least_share_clear) < limits_.least_clear) return false;
    std::size_t on_furniture = 0;
    for (const std::size_t cell : part.cells) on_furniture += stands_on(cell, below);
    return 2 * on_furniture < part.cells.size();
  }

  bool stands_on(std::size_t cell, std::span<const Room> below) const {
    const double u = raster_.middle_u(raster_.column_of(cell)), v = raster_.middle_v(raster_.row_of(cell));
    return std::ranges::any_of(below, [&](const Room& room) {
      return floor_.height - room.floor_height < height_of_furniture && room.cell_at(u, v) != Room::Cell::elsewhere;
    });
  }

  /// Returns the shorter side of the rectangle about a part, metres.
  double shorter_side(const Part& part) const {
    return std::min((part.last_column - part.first_column + 1) * raster_.cell_u,
                    (part.last_row - part.first_row + 1) * raster_.cell_v);
  }

  /// Divides a part of the floor at its doors. A room is what is left connected after a strip along the walls, as wide as half a
  /// door, is taken away, and what of the strip lies near it. Places that are too narrow for that, like corridors, are rooms,
  /// too.
  void add_rooms_of(const Part& part, std::vector<Room>& rooms) const {
    const double reach = std::min(half_door, shorter_side(part) / 4);
    std::vector<std::uint32_t> owners(floor_.cells.size(), none);
    std::vector<bool> is_of_part(floor_.cells.size());
    for (const std::size_t cell : part.cells) is_of_part[cell] = true;
    std::uint32_t count = 0;
    const auto take = [&](double least, auto belongs) {
      std::uint32_t found = 0;
      const auto numbers = parts_of(floor_, found, belongs);
      for (const Part& each : collected(raster_, numbers, found)) {
        if (static_cast<double>(each.cells.size()) * cell_area() < least) continue;
        for (const std::size_t cell : each.cells) owners[cell] = count;
        ++count;
      }
    };
    take(least_core, [&](std::size_t cell) { return is_of_part[cell] && floor_.to_edge[cell] >= reach; });
    grow(owners, 1.5 * reach);
    take(least_area, [&](std::size_t cell) { return is_of_part[cell] && owners[cell] == none; });
    grow(owners, std::numeric_limits<double>::infinity());
    for (const Part& owned : collected(raster_, owners, count))
      if (is_wide_enough(owned) && (!limits_.needs_ceiling || is_covered(floor_, owned))) rooms.push_back(room_of(owned));
  }

  /// Returns whether somebody can stand there. The insides of walls whose faces have two sides cannot be told from rooms but by
  /// their width.
  bool is_wide_enough(const Part& part) const {
    const double across = std::min(raster_.columns * raster_.cell_u, raster_.rows * raster_.cell_v);
    return local_width(part) >= std::min(least_width, across / 2);
  }

  /// Returns the diameter of the largest circle within a part, metres.
  double local_width(const Part& part) const {
    float most = 0;
    for (const std::size_t cell : part.cells) most = std::max(most, floor_.to_edge[cell]);
    return 2 * most;
  }

  /// Gives each cell of the floor to the room from which it is reached first, within a distance.
  void grow(std::vector<std::uint32_t>& owners, double most) const {
    std::vector<std::size_t> edge, next_edge;
    for (std::size_t cell = 0; cell < owners.size(); ++cell)
      if (owners[cell] != none) edge.push_back(cell);
    const double step = std::min(raster_.cell_u, raster_.cell_v);
    for (double way = 0; !edge.empty() && way < most; way += step, edge.swap(next_edge), next_edge.clear())
      for (const std::size_t cell : edge)
        floor_.for_open_neighbours(cell, [&](std::size_t next) {
          if (owners[next] != none || !floor_.cells[next].is_floor) return;
          owners[next] = owners[cell];
          next_edge.push_back(next);
        });
  }

  double median_surface(const Part& part) const {
    std::vector<float> surfaces;
    for (const std::size_t cell : part.cells) surfaces.push_back(floor_.cells[cell].surface);
    const auto middle = surfaces.begin() + static_cast<std::ptrdiff_t>(surfaces.size() / 2);
    std::ranges::nth_element(surfaces, middle);
    return *middle;
  }

  Room room_of(const Part& part) const {
    Room room;
    room.local_width = std::min(local_width(part), shorter_side(part));
    const double border = std::min(limits_.border, most_border * room.local_width);
    const auto is_border = [&](std::size_t cell) { return floor_.to_edge[cell] < border; };
    room.frame = frame_;
    room.floor_height = floor_.height + median_surface(part);
    room.clear_height = height_of_share(floor_, part, 0.1);  // most of the room may lie under furniture
    room.area = static_cast<double>(part.cells.size()) * cell_area();
    room.raster = {raster_.left + part.first_column * raster_.cell_u,
                   raster_.bottom + part.first_row * raster_.cell_v,
                   raster_.cell_u,
                   raster_.cell_v,
                   part.last_column - part.first_column + 1,
                   part.last_row - part.first_row + 1};
    room.cells.assign(room.raster.size(), Room::Cell::elsewhere);
    room.surface.assign(room.raster.size(), 0);
    std::vector<std::size_t> inner;
    for (const std::size_t cell : part.cells) {
      const std::size_t here =
          room.raster.index(raster_.column_of(cell) - part.first_column, raster_.row_of(cell) - part.first_row);
      room.cells[here] = is_border(cell) ? Room::Cell::border : Room::Cell::inner;
      room.surface[here] = static_cast<float>(floor_.height + floor_.cells[cell].surface - room.floor_height);
      if (!is_border(cell)) inner.push_back(here);
    }
    const Part bounds = part_of(room.raster, std::move(inner));
    room.left = room.raster.left + bounds.first_column * raster_.cell_u;
    room.bottom = room.raster.bottom + bounds.first_row * raster_.cell_v;
    room.length = (bounds.last_column - bounds.first_column + 1) * raster_.cell_u;
    room.width = (bounds.last_row - bounds.first_row + 1) * raster_.cell_v;
    room.floor_triangle = floor_.cells[part.cells[part.cells.size() / 2]].triangle;
    return room;
  }

  const FloorRaster& floor_;
  const PlanRaster& raster_;
  const PlanFrame& frame_;
  const RoomLimits& limits_;
};

}  // namespace

std::vector<Room> rooms_on(const FloorRaster& floor, const PlanFrame& frame, const RoomLimits& limits,
                           std::span<const Room> below) {
  return LevelRooms(floor, frame, limits).rooms_above(below);
}

}  // namespace alvor
