#pragma once

#include "client/report/floor_raster.h"

namespace alvor {

/// Takes what stands free on a floor out of its walls: what blocks the way between cells, is connected neither to another wall
/// nor to the end of the floor, and is no longer than 1.5 m, such as a pillar or a locker, or is narrow and no longer than 6 m,
/// such as a screen between desks. Its cells become pillars, and the ways between the cells around it open.
void open_pillars(FloorRaster& floor);

}  // namespace alvor
