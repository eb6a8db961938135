#pragma once
// One furnished office: four metres wide, five deep, its door in the wall z = 0.

#include "bench/obj_writer.h"

#include <random>

namespace alvor::bench {

constexpr double room_wide = 4, room_deep = 5, storey_high = 2.8;
constexpr double door_low = 2.9, door_high = 3.8, door_top = 2.1;

/// The same numbers from the same seed, whatever the standard library.
class Chance {
 public:
  explicit Chance(unsigned seed) : engine_(seed) {}
  int below(int end) { return static_cast<int>(engine_() % static_cast<unsigned>(end)); }
  double between(double low, double high) { return low + (high - low) * below(10000) / 10000; }

 private:
  std::minstd_rand engine_;
};

/// Floor, ceiling and walls; with a doorway, the wall z = 0 has an opening.
void add_room_shell(ObjWriter& obj, const Place& room, bool has_doorway);

/// The wall z = `at_z` from x = `from` to `to` around the doorway, seen from inside the room or from outside.
void add_doorway_wall(ObjWriter& obj, double from, double to, double at_z, bool from_inside);

/// Hangs one box under the ceiling; its lower face shines.
void add_lamp(ObjWriter& obj, Vec3 centre, double along_x, double along_z);

/// Hangs `count` lamps in rows.
void add_lamps(ObjWriter& obj, const Place& room, int count);

/// Furnishes the room until `obj` has `face_limit` faces, or up to four fewer, unless the room is full or over it already.
void furnish(ObjWriter& obj, const Place& room, int face_limit, Chance& chance);

}  // namespace alvor::bench
