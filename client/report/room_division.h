#pragma once
// Divides a level into rooms.

#include "client/report/rooms.h"

#include <span>
#include <vector>

namespace alvor {

struct RoomLimits {
  double border = 0.5;        ///< metres from the walls that are not assessed; at most 15 % of a room's local width
  double least_clear = 1.5;   ///< floors with less room above are none, metres
  bool needs_ceiling = true;  ///< floors open to the sky are none
};

/// Returns the rooms of a level, without names. Levels less than 1.8 m above one of the rooms `below` are tops of furniture
/// there. Requires: open_pillars(floor) and measure_edges(floor) were called.
std::vector<Room> rooms_on(const FloorRaster& floor, const PlanFrame& frame, const RoomLimits& limits,
                           std::span<const Room> below);

}  // namespace alvor
