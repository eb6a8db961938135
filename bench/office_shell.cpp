#include "bench/office_room.h"

#include <algorithm>
#include <cmath>

namespace alvor::bench {

void add_room_shell(ObjWriter& obj, const Place& room, bool has_doorway) {
  const Vec3 low{0, 0, 0}, high{room_wide, storey_high, room_deep};
  obj.stand_at(room);
  obj.box("carpet", low, high, ~bottom, true);
  obj.box("ceiling", low, high, ~top, true);
  obj.box("wall", low, high, bottom | top | (has_doorway ? z_low : 0), true);
  if (has_doorway) add_doorway_wall(obj, "wall", door_wall, 0, true);
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
