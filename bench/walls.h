#pragma once
// Generates rooms, walls with doorways, and lamps.

#include "bench/obj_writer.h"

namespace alvor::bench {

/// Adds a room from the origin to `size`, metres, of the materials `floor`, `ceiling` and `wall`.
void add_closed_room(ObjWriter& obj, Vec3 size);

/// A vertical wall along x with a door opening down to the floor. Metres.
struct DoorwayWall {
  double from = 0, to = 0, height = 0;
  double door_low = 0, door_high = 0, door_top = 2.1;
};

/// Adds one side of the wall, at z = `at_z`; its front faces higher or lower z.
void add_doorway_wall(ObjWriter& obj, const char* material, const DoorwayWall& wall, double at_z, bool looks_to_high_z);

/// Adds the faces inside the opening of a thick wall: jambs, lintel and threshold.
void add_doorway(ObjWriter& obj, const char* material, const char* floor, const DoorwayWall& wall, double from_z, double to_z);

/// Adds a lamp: a box that hangs from the middle of its upper side, which is left out; the lower face emits. Its materials are
/// `housing` and `lamp`.
void add_lamp(ObjWriter& obj, Vec3 hung_from, double along_x, double along_z);

}  // namespace alvor::bench
