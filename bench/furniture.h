#pragma once
// Furniture that several generated scenes share. Solids stand on the floor without the faces that nobody sees.

#include "bench/obj_writer.h"

namespace alvor::bench {

/// Four legs at the corners of a rectangle about the place at which `obj` stands, up to `top_y`.
void add_legs(ObjWriter& obj, const char* material, double along_x, double along_z, double top_y, double thickness);

/// About its place.
void add_table(ObjWriter& obj, const char* material, Place place, double along_x, double along_z, double top_y);

/// About its place; who sits on it looks towards +z.
void add_chair(ObjWriter& obj, const char* material, Place place);

}  // namespace alvor::bench
