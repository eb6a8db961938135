// slats_and_boxes DIR: writes slats_and_boxes.obj and .mtl, a room in which two hundred small objects cast shadows: hanging
// boxes, upright slats, a slatted bench and cubes on the floor. The output is always the same. Lengths are metres, y is up.

#include "bench/chance.h"
#include "bench/furniture.h"
#include "bench/scene_program.h"
#include "bench/walls.h"

#include <array>

namespace alvor::bench {

namespace {

constexpr std::array paints{Paint{"wall", "Kd 0.75 0.73 0.68"},    Paint{"floor", "Kd 0.48 0.36 0.25"},
                            Paint{"slat", "Kd 0.62 0.46 0.30"},    Paint{"bench", "Kd 0.40 0.26 0.16"},
                            Paint{"red", "Kd 0.65 0.14 0.10"},     Paint{"amber", "Kd 0.78 0.52 0.12"},
                            Paint{"teal", "Kd 0.10 0.42 0.42"},    Paint{"cream", "Kd 0.82 0.78 0.66"},
                            Paint{"housing", "Kd 0.70 0.70 0.70"}, Paint{"lamp", "Kd 0 0 0\nKe 20 19 17"}};
constexpr std::array colours{"red", "amber", "teal", "cream"};
constexpr double width = 4, height = 3, depth = 4;

const char* any_colour(Chance& chance) { return colours[static_cast<std::size_t>(chance.below(colours.size()))]; }

void add_room(ObjWriter& obj) {
  const Vec3 low{0, 0, 0}, high{width, height, depth};
  obj.stand_at({});
  obj.box("floor", low, high, ~bottom, true);
  obj.box("wall", low, high, bottom, true);
  add_lamp(obj, {1.2, height, 1.4}, 0.5, 0.5);
  add_lamp(obj, {2.9, height, 2.7}, 0.9, 0.25);
}

/// Adds five rows of eight boxes in three layers, turned at random; none touches another.
void add_hanging_boxes(ObjWriter& obj, Chance& chance) {
  constexpr double pitch = 0.37;
  for (int box = 0; box < 120; ++box) {
    const Vec3 cell{0.75 + pitch * (box % 8), 1.55 + pitch * (box / 40), 0.8 + pitch * (box / 8 % 5)};
    const double wide = chance.between(0.06, 0.16), deep = chance.between(0.06, 0.16), tall = chance.between(0.04, 0.16);
    obj.stand_at({cell.x + chance.between(-0.06, 0.06), cell.z + chance.between(-0.06, 0.06), chance.between(0, 90),
                  cell.y + chance.between(-0.08, 0.08)});
    obj.box(any_colour(chance), {-wide / 2, 0, -deep / 2}, {wide / 2, tall, deep / 2});
  }
}

/// Adds upright louvres under a rail, parallel to the back wall.
void add_screen(ObjWriter& obj) {
  constexpr double rail_y = 2.2, z = 3.1;
  for (int slat = 0; slat < 24; ++slat) {
    obj.stand_at({1.28 + 0.1 * slat, z, 40});
    obj.box("slat", {-0.06, 0, -0.008}, {0.06, rail_y, 0.008}, bottom | top);
  }
  obj.stand_at({});
  obj.box("bench", {1.2, rail_y, z - 0.05}, {3.66, rail_y + 0.06, z + 0.05});
}

void add_slatted_bench(ObjWriter& obj) {
  const Place place{0.5, 2.6, 90};
  obj.stand_at(place);
  for (const double x : {-0.7, 0.62}) {
    for (const double z : {-0.22, 0.14}) obj.box("bench", {x, 0, z}, {x + 0.08, 0.38, z + 0.08}, bottom | top);
    obj.box("bench", {x, 0.38, -0.235}, {x + 0.08, 0.415, 0.235});
  }
  for (int slat = 0; slat < 12; ++slat) {
    const double z = -0.235 + 0.04 * slat;
    obj.box("slat", {-0.75, 0.42, z}, {0.75, 0.445, z + 0.03});
  }
}

/// Adds cubes in front of the screen, with smaller ones on top of some.
void add_cubes(ObjWriter& obj, Chance& chance) {
  for (int cube = 0; cube < 30; ++cube) {
    const double side = chance.between(0.09, 0.15);
    const Place place{1.2 + 0.28 * (cube % 10) + chance.between(-0.03, 0.03),
                      0.5 + 0.6 * (cube / 10) + chance.between(-0.19, 0.19), chance.between(0, 90)};
    obj.stand_at(place);
    obj.box(any_colour(chance), {-side / 2, 0, -side / 2}, {side / 2, side, side / 2}, bottom);
    if (cube % 3 != 0) continue;
    obj.stand_at(placed_in(place, {.turn_degrees = 30, .y = side}));
    obj.box(any_colour(chance), {-0.03, 0, -0.03}, {0.03, 0.06, 0.03}, bottom);
  }
}

ObjWriter slats_and_boxes() {
  ObjWriter obj;
  Chance chance(3);
  add_room(obj);
  add_hanging_boxes(obj, chance);
  add_screen(obj);
  add_slatted_bench(obj);
  add_cubes(obj, chance);
  return obj;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) {
  using namespace alvor::bench;
  return run_scene_program(count, arguments, "slats_and_boxes", paints, slats_and_boxes);
}
