#include "bench/office_room.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alvor::bench {

void add_room_shell(ObjWriter& obj, const Place& room, bool has_doorway) {
  const Vec3 low{0, 0, 0}, high{room_wide, storey_high, room_deep};
  obj.stand_at(room);
  obj.box("carpet", low, high, ~bottom, true);
  obj.box("ceiling", low, high, ~top, true);
  obj.box("wall", low, high, bottom | top | (has_doorway ? z_low : 0), true);
  if (has_doorway) add_doorway_wall(obj, 0, room_wide, 0, true);
}

// Cut at the height of the lintel all along: pieces share whole edges, so that light is interpolated across them.
void add_doorway_wall(ObjWriter& obj, double from, double to, double at_z, bool from_inside) {
  constexpr std::array heights{0.0, door_top, storey_high};
  const std::array widths{from, door_low, door_high, to};
  for (std::size_t row = 0; row < 2; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      if (row == 1 || column != 1)
        obj.box("wall", {widths[column], heights[row], at_z}, {widths[column + 1], heights[row + 1], at_z}, ~z_low, from_inside);
}

void add_lamp(ObjWriter& obj, Vec3 centre, double along_x, double along_z) {
  const Vec3 low{centre.x - along_x / 2, centre.y - 0.06, centre.z - along_z / 2};
  const Vec3 high{centre.x + along_x / 2, centre.y, centre.z + along_z / 2};
  obj.box("housing", low, high, top | bottom);
  obj.box("lamp", low, high, ~bottom);
}

void add_lamps(ObjWriter& obj, const Place& room, int count) {
  if (count <= 0) return;
  const int columns = static_cast<int>(std::ceil(std::sqrt(count * room_wide / room_deep)));
  const int rows = (count + columns - 1) / columns;
  const double pitch_x = room_wide / columns, pitch_z = room_deep / rows;
  obj.stand_at(room);
  for (int lamp = 0; lamp < count; ++lamp) {
    const Vec3 centre{pitch_x * (lamp % columns + 0.5), storey_high, pitch_z * (lamp / columns + 0.5)};
    add_lamp(obj, centre, std::min(1.2, pitch_x * 0.6), std::min(0.3, pitch_z * 0.6));
  }
}

}  // namespace alvor::bench
