#pragma once
// Generates an office block of any size: storeys of rooms on both sides of a corridor, joined by doorways.

#include "bench/obj_writer.h"

namespace alvor::bench {

struct OfficeOptions {
  int faces = 1000;                  ///< approximate number of faces, 100 to 1 000 000
  unsigned seed = 1;                 ///< moves furniture and changes its colours
  double lamps_per_1000_faces = 12;  ///< 0 to 100
};

struct OfficeBlock {
  ObjWriter obj;
  int rooms = 0, storeys = 0, lamps = 0;
};

std::span<const Paint> office_paints();

/// Returns a closed office block: no light leaves it, or passes from one storey to another.
OfficeBlock office_block(const OfficeOptions& options);

}  // namespace alvor::bench
