#pragma once
// Walls with doorways, and lamps.

#include "bench/obj_writer.h"

namespace alvor::bench {

/// Along x and upright, with an opening down to the floor. Metres.
struct DoorwayWall {
  double from = 0, to = 0, height = 0;
  double door_low = 0, door_high = 0, door_top = 2.1;
};

/// One side of the wall, at z = `at_z`; its front looks to higher z or to lower.
void add_doorway_wall(ObjWriter& obj, const char* material, const DoorwayWall& wall, double at_z, bool looks_to_high_z);

/// What is seen between the two sides of a thick wall: jambs, lintel and threshold.
void add_doorway(ObjWriter& obj, const char* material, const char* floor, const DoorwayWall& wall, double from_z, double to_z);

/// A box that hangs from the middle of its upper side, which is left out; its lower face shines. Materials: housing and lamp.
void add_lamp(ObjWriter& obj, Vec3 hung_from, double along_x, double along_z);

}  // namespace alvor::bench
