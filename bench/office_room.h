#pragma once
// Generates one furnished office: four metres wide, five deep, with its door in the wall z = 0.

#include "bench/chance.h"
#include "bench/walls.h"

namespace alvor::bench {

constexpr double room_wide = 4, room_deep = 5, storey_high = 2.8;
constexpr DoorwayWall door_wall{.to = room_wide, .height = storey_high, .door_low = 2.9, .door_high = 3.8};

/// Adds floor, ceiling and walls; with a doorway, the wall z = 0 has an opening.
void add_room_shell(ObjWriter& obj, const Place& room, bool has_doorway);

/// Hangs `count` lamps in rows.
void add_lamps(ObjWriter& obj, const Place& room, int count);

/// Furnishes the room until `obj` has `face_limit` faces, or up to four fewer. Stops earlier if the room is full; adds nothing if
/// `obj` already has more.
void furnish(ObjWriter& obj, const Place& room, int face_limit, Chance& chance);

}  // namespace alvor::bench
