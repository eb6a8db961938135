#pragma once
// Furniture that several generated scenes share. Solids that stand on the floor have no bottom faces.

#include "bench/obj_writer.h"

namespace alvor::bench {

/// Adds four legs at the corners of a rectangle centred on the writer's current place, up to height `top_y`, metres.
void add_legs(ObjWriter& obj, const char* material, double along_x, double along_z, double top_y, double thickness);

/// Adds a table centred on `place`, its top at height `top_y`, metres.
void add_table(ObjWriter& obj, const char* material, Place place, double along_x, double along_z, double top_y);

/// Adds a chair centred on `place`, which faces +z.
void add_chair(ObjWriter& obj, const char* material, Place place);

}  // namespace alvor::bench
