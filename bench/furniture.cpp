#include "bench/furniture.h"

namespace alvor::bench {

void add_legs(ObjWriter& obj, const char* material, double along_x, double along_z, double top_y, double thickness) {
  for (const double x : {-along_x / 2, along_x / 2 - thickness})
    for (const double z : {-along_z / 2, along_z / 2 - thickness})
      obj.box(material, {x, 0, z}, {x + thickness, top_y, z + thickness}, bottom | top);
}

void add_table(ObjWriter& obj, const char* material, Place place, double along_x, double along_z, double top_y) {
  obj.stand_at(place);
  obj.box(material, {-along_x / 2, top_y - 0.04, -along_z / 2}, {along_x / 2, top_y, along_z / 2});
  add_legs(obj, material, along_x - 0.1, along_z - 0.1, top_y - 0.04, 0.07);
}

void add_chair(ObjWriter& obj, const char* material, Place place) {
  obj.stand_at(place);
  obj.box(material, {-0.22, 0.43, -0.22}, {0.22, 0.46, 0.22});
  add_legs(obj, material, 0.42, 0.42, 0.43, 0.04);
  for (const double x : {-0.21, 0.17}) obj.box(material, {x, 0.46, -0.21}, {x + 0.04, 0.95, -0.17}, bottom);
  for (const double y : {0.60, 0.72, 0.84}) obj.box(material, {-0.17, y, -0.20}, {0.17, y + 0.07, -0.18}, x_low | x_high);
}

}  // namespace alvor::bench
