// enfilade DIR: writes enfilade.obj and .mtl, four rooms in a row, joined by doorways that are not in line with one another. The
// only lamp shines at the ceiling of the first room from above the lintels, so no other room sees it. The output is always the
// same. Lengths are metres, y is up.

#include "bench/furniture.h"
#include "bench/scene_program.h"
#include "bench/walls.h"

#include <array>

namespace alvor::bench {

namespace {

constexpr std::array paints{Paint{"wall", "Kd 0.80 0.79 0.76"},    Paint{"ceiling", "Kd 0.86 0.86 0.85"},
                            Paint{"floor", "Kd 0.50 0.36 0.24"},   Paint{"ochre", "Kd 0.78 0.58 0.28"},
                            Paint{"rose", "Kd 0.76 0.38 0.34"},    Paint{"sky", "Kd 0.36 0.54 0.74"},
                            Paint{"oak", "Kd 0.58 0.42 0.26"},     Paint{"stone", "Kd 0.70 0.69 0.66"},
                            Paint{"housing", "Kd 0.70 0.70 0.70"}, Paint{"lamp", "Kd 0 0 0\nKe 40 38 34"}};
constexpr double length = 6, width = 3, height = 3, wall_thick = 0.2;
constexpr int room_count = 4;
constexpr std::array side_walls{"wall", "ochre", "rose", "sky"};

double start_of(int room) { return room * (length + wall_thick); }

void add_room(ObjWriter& obj, int room) {
  const Vec3 low{0, 0, 0}, high{length, height, width};
  obj.stand_at({start_of(room)});
  obj.box("floor", low, high, ~bottom, true);
  obj.box("ceiling", low, high, ~top, true);
  obj.box(side_walls[static_cast<std::size_t>(room)], low, high, ~z_low, true);
  obj.box("wall", low, high, ~z_high, true);
  if (room == 0) obj.box("wall", low, high, ~x_low, true);
  if (room == room_count - 1) obj.box("wall", low, high, ~x_high, true);
}

/// Adds the wall between two rooms. Seen from the first one, x runs along the wall from right to left. Doorways are left and
/// right in turn.
void add_partition(ObjWriter& obj, int room_before) {
  const double low = room_before % 2 == 0 ? 0.2 : width - 1.4;
  const DoorwayWall wall{.to = width, .height = height, .door_low = low, .door_high = low + 1.2};
  obj.stand_at({start_of(room_before) + length, width, 90});
  add_doorway_wall(obj, "wall", wall, 0, false);
  add_doorway_wall(obj, "wall", wall, wall_thick, true);
  add_doorway(obj, "wall", "floor", wall, 0, wall_thick);
}

/// Adds a lamp on the wall z = `width`, whose upper face emits.
void add_cove_lamp(ObjWriter& obj) {
  const Vec3 low{1, 2.3, width - 0.25}, high{5, 2.4, width};
  obj.stand_at({});
  obj.box("housing", low, high, top | z_high);
  obj.box("lamp", low, high, ~top);
}

void add_bench(ObjWriter& obj, int room, double x, double z) { add_table(obj, "oak", {start_of(room) + x, z}, 1.4, 0.4, 0.44); }

void add_plinth(ObjWriter& obj, int room, double x, double z) {
  obj.stand_at({start_of(room) + x, z, 20});
  obj.box("stone", {-0.2, 0, -0.2}, {0.2, 0.9, 0.2}, bottom);
  obj.box("ochre", {-0.1, 0.9, -0.1}, {0.1, 1.2, 0.1}, bottom);
}

/// Adds a picture on the wall z = 0.
void add_picture(ObjWriter& obj, int room, double x, const char* colour) {
  obj.stand_at({start_of(room) + x});
  obj.box("oak", {0, 1.2, 0}, {1.2, 2.0, 0.04}, z_low | z_high);
  obj.box(colour, {0, 1.2, 0}, {1.2, 2.0, 0.04}, ~z_high);
}

ObjWriter enfilade() {
  ObjWriter obj;
  for (int room = 0; room < room_count; ++room) add_room(obj, room);
  for (int room = 0; room + 1 < room_count; ++room) add_partition(obj, room);
  add_cove_lamp(obj);
  for (int room = 1; room < room_count; ++room) {
    add_bench(obj, room, 3, 0.6);
    add_picture(obj, room, 2.4, room == 3 ? "rose" : "sky");
    add_plinth(obj, room, room % 2 ? 4.9 : 1.1, 2.4);
  }
  return obj;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) {
  using namespace alvor::bench;
  return run_scene_program(count, arguments, "enfilade", paints, enfilade);
}
