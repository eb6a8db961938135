#include "bench/walls.h"

#include <array>

namespace alvor::bench {

void add_closed_room(ObjWriter& obj, Vec3 size) {
  obj.stand_at({});
  obj.box("floor", {}, size, ~bottom, true);
  obj.box("ceiling", {}, size, ~top, true);
  obj.box("wall", {}, size, bottom | top, true);
}

// Cuts the whole wall at the height of the lintel: then the pieces share whole edges, and light is interpolated across them.
void add_doorway_wall(ObjWriter& obj, const char* material, const DoorwayWall& wall, double at_z, bool looks_to_high_z) {
  const std::array heights{0.0, wall.door_top, wall.height};
  const std::array widths{wall.from, wall.door_low, wall.door_high, wall.to};
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      if (row == 1 || column != 1)
        obj.box(material, {widths[column], heights[row], at_z}, {widths[column + 1], heights[row + 1], at_z}, ~z_low,
                looks_to_high_z);
}

void add_doorway(ObjWriter& obj, const char* material, const char* floor, const DoorwayWall& wall, double from_z, double to_z) {
  const Vec3 low{wall.door_low, 0, from_z}, high{wall.door_high, wall.door_top, to_z};
  obj.box(floor, low, high, ~bottom, true);
  obj.box(material, low, high, bottom | z_low | z_high, true);
}

void add_lamp(ObjWriter& obj, Vec3 hung_from, double along_x, double along_z) {
  const Vec3 low{hung_from.x - along_x / 2, hung_from.y - 0.06, hung_from.z - along_z / 2};
  const Vec3 high{hung_from.x + along_x / 2, hung_from.y, hung_from.z + along_z / 2};
  obj.box("housing", low, high, top | bottom);
  obj.box("lamp", low, high, ~bottom);
}

}  // namespace alvor::bench
