#include "bench/office.h"

#include "bench/office_room.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace alvor::bench {

namespace {

constexpr double wall_thick = 0.1, slab_thick = 0.3, corridor_wide = 2;
constexpr double bay_pitch = room_wide + wall_thick;
// Faces of two workplaces, shelves with folders, a cupboard, and half of a corridor's bay.
constexpr double faces_of_a_room = 520;

constexpr std::array paints{
    Paint{"wall", "Kd 0.76 0.74 0.70"},  Paint{"ceiling", "Kd 0.85 0.85 0.85"},  Paint{"carpet", "Kd 0.28 0.30 0.34"},
    Paint{"beech", "Kd 0.66 0.50 0.34"}, Paint{"steel", "Kd 0.55 0.56 0.58"},    Paint{"plastic", "Kd 0.10 0.10 0.10"},
    Paint{"blue", "Kd 0.12 0.22 0.48"},  Paint{"charcoal", "Kd 0.14 0.14 0.15"}, Paint{"red", "Kd 0.58 0.12 0.10"},
    Paint{"green", "Kd 0.14 0.38 0.20"}, Paint{"yellow", "Kd 0.74 0.60 0.16"},   Paint{"paper", "Kd 0.80 0.79 0.75"},
    Paint{"card", "Kd 0.52 0.40 0.27"},  Paint{"housing", "Kd 0.70 0.70 0.70"},  Paint{"lamp", "Kd 0 0 0\nKe 10 9.6 9"}};

/// Builds the block. It counts faces and lamps as rooms are added, so that each room makes up for the rounding of those before.
class Builder {
 public:
  explicit Builder(const OfficeOptions& options) : options_(options), chance_(options.seed + 1) {
    room_count_ = std::max(1, static_cast<int>(std::lround(options.faces / faces_of_a_room)));
    block_.storeys = std::max(1, static_cast<int>(std::lround(std::sqrt(room_count_ / 5.0))));
  }

  OfficeBlock build() {
    for (int storey = 0; storey < block_.storeys; ++storey) add_storey(storey);
    return std::move(block_);
  }

 private:
  int share(int whole, int part, int parts) const { return static_cast<int>(std::int64_t{whole} * part / parts); }

  void add_storey(int storey) {
    const int rooms = share(room_count_, storey + 1, block_.storeys) - share(room_count_, storey, block_.storeys);
    const double y = storey * (storey_high + slab_thick);
    if (rooms == 1) return add_room({.y = y}, false);
    for (int bay = 0; 2 * bay < rooms; ++bay) add_bay(bay, rooms, y);
  }

  void add_bay(int bay, int rooms, double y) {
    const int bays = (rooms + 1) / 2;
    const double x = bay * bay_pitch, wall_z = corridor_wide / 2 + wall_thick;
    const Place left{x, wall_z, 0, y}, right{x + room_wide, -wall_z, 180, y};
    add_corridor({x - wall_thick / 2, 0, 0, y}, bay == 0, bay == bays - 1);
    add_corridor_wall(left, true);
    add_corridor_wall(right, 2 * bay + 1 < rooms);
    add_room(left, true);
    if (2 * bay + 1 < rooms) add_room(right, true);
  }

  void add_corridor(const Place& place, bool is_first, bool is_last) {
    const Vec3 low{0, 0, -corridor_wide / 2}, high{bay_pitch, storey_high, corridor_wide / 2};
    ObjWriter& obj = block_.obj;
    obj.numbered_object("corridor");
    obj.stand_at(place);
    obj.box("carpet", low, high, ~bottom, true);
    obj.box("ceiling", low, high, ~top, true);
    if (is_first) obj.box("wall", low, high, ~x_low, true);
    if (is_last) obj.box("wall", low, high, ~x_high, true);
    if (lamps_due(block_.rooms + 1) < 2) return;
    add_lamp(obj, {bay_pitch / 2, storey_high, 0}, 1.2, 0.2);
    ++block_.lamps;
  }

  void add_corridor_wall(const Place& room, bool has_doorway) {
    DoorwayWall wall = door_wall;
    wall.from = -wall_thick / 2, wall.to = room_wide + wall_thick / 2;
    ObjWriter& obj = block_.obj;
    obj.numbered_object("corridor_wall");
    obj.stand_at(room);
    if (!has_doorway) return obj.box("wall", {wall.from, 0, -wall_thick}, {wall.to, storey_high, -wall_thick}, ~z_low);
    add_doorway_wall(obj, "wall", wall, -wall_thick, false);
    add_doorway(obj, "wall", "carpet", wall, -wall_thick, 0);
  }

  void add_room(const Place& place, bool has_doorway) {
    ++block_.rooms;
    const int lamps = lamps_due(block_.rooms);
    block_.obj.numbered_object("room");
    add_room_shell(block_.obj, place, has_doorway);
    add_lamps(block_.obj, place, lamps);
    block_.lamps += lamps;
    furnish(block_.obj, place, share(options_.faces, block_.rooms, room_count_), chance_);
  }

  /// Returns how many lamps are missing once there are `rooms` rooms.
  int lamps_due(int rooms) const {
    const double all = options_.faces * options_.lamps_per_1000_faces / 1000;
    return static_cast<int>(std::lround(all * rooms / room_count_)) - block_.lamps;
  }

  OfficeOptions options_;
  Chance chance_;
  int room_count_ = 1;
  OfficeBlock block_;
};

}  // namespace

std::span<const Paint> office_paints() { return paints; }

OfficeBlock office_block(const OfficeOptions& options) { return Builder(options).build(); }

}  // namespace alvor::bench
