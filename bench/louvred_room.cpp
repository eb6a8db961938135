// louvred_room DIR: writes louvred_room.obj and .mtl, an office that is lit only from within: by two luminaires, each a tube in a
// white housing behind nine blades, and by a lamp in a shade. The output is always the same. Lengths are metres, y is up.

#include "bench/furniture.h"
#include "bench/scene_program.h"
#include "bench/walls.h"

#include <cmath>
#include <numbers>

namespace alvor::bench {

namespace {

constexpr Paint paints[]{
    {"wall", "Kd 0.72 0.70 0.66"},   {"ceiling", "Kd 0.84 0.84 0.82"},     {"floor", "Kd 0.34 0.32 0.30"},
    {"oak", "Kd 0.56 0.42 0.28"},    {"steel", "Kd 0.45 0.46 0.48"},       {"cloth", "Kd 0.20 0.26 0.38"},
    {"binder", "Kd 0.58 0.20 0.14"}, {"paper", "Kd 0.82 0.81 0.78"},       {"housing", "Kd 0.88 0.88 0.88"},
    {"shade", "Kd 0.70 0.62 0.46"},  {"lamp", "Kd 0 0 0\nKe 160 155 145"}, {"bulb", "Kd 0 0 0\nKe 220 180 120"}};

constexpr double width = 5.2, height = 2.8, depth = 4.2;

/// Adds a luminaire along x that hangs 0.25 m below the ceiling: a housing that is open below, a tube of square section in it,
/// and nine blades across the opening.
void add_luminaire(ObjWriter& obj, const Place& place) {
  constexpr double half_long = 0.6, half_wide = 0.15, tall = 0.12, thick = 0.01, blade_tall = 0.05;
  constexpr int blades = 9;
  const double low = height - 0.25 - tall, high = height - 0.25;
  obj.stand_at(place);
  obj.box("housing", {-half_long, high - thick, -half_wide}, {half_long, high, half_wide});
  for (const double z : {-half_wide, half_wide - thick})
    obj.box("housing", {-half_long, low, z}, {half_long, high - thick, z + thick}, top);
  for (const double x : {-half_long, half_long - thick})
    obj.box("housing", {x, low, -half_wide + thick}, {x + thick, high - thick, half_wide - thick}, top | z_low | z_high);
  obj.box("lamp", {-half_long + 0.03, high - 0.05, -0.013}, {half_long - 0.03, high - 0.024, 0.013});
  for (int blade = 1; blade <= blades; ++blade) {
    const double x = -half_long + 2 * half_long * blade / (blades + 1);
    obj.box("housing", {x - 0.002, low, -half_wide + thick}, {x + 0.002, low + blade_tall, half_wide - thick}, z_low | z_high);
  }
}

/// Adds a lamp on a table: a foot, a stem, a bulb, and a shade of twelve sides that is open above and below.
void add_shaded_lamp(ObjWriter& obj, const Place& place) {
  constexpr int sides = 12;
  constexpr double low = 0.28, high = 0.50, lower_radius = 0.16, upper_radius = 0.10, thick = 0.004;
  obj.stand_at(place);
  obj.box("steel", {-0.07, 0, -0.07}, {0.07, 0.02, 0.07}, bottom);
  obj.box("steel", {-0.01, 0.02, -0.01}, {0.01, 0.30, 0.01}, bottom | top);
  obj.box("bulb", {-0.03, 0.30, -0.03}, {0.03, 0.36, 0.03});
  int ring[2][2][sides];  // outside and inside, lower and upper
  for (int inside = 0; inside < 2; ++inside)
    for (int upper = 0; upper < 2; ++upper)
      for (int side = 0; side < sides; ++side) {
        const double angle = 2 * std::numbers::pi * side / sides, radius = (upper ? upper_radius : lower_radius) - inside * thick;
        ring[inside][upper][side] = obj.vertex({radius * std::cos(angle), upper ? high : low, -radius * std::sin(angle)});
      }
  for (int side = 0; side < sides; ++side) {
    const int next = (side + 1) % sides;
    const auto add = [&](int a, int b, int c, int d) { obj.face("shade", std::array{a, b, c, d}); };
    add(ring[0][0][side], ring[0][0][next], ring[0][1][next], ring[0][1][side]);
    add(ring[1][0][next], ring[1][0][side], ring[1][1][side], ring[1][1][next]);
    add(ring[1][0][side], ring[1][0][next], ring[0][0][next], ring[0][0][side]);
    add(ring[0][1][side], ring[0][1][next], ring[1][1][next], ring[1][1][side]);
  }
}

/// Adds a shelf with its back at z = 0, full of binders.
void add_shelf(ObjWriter& obj, const Place& place) {
  constexpr double wide = 1.2, tall = 1.9, deep = 0.32, board = 0.02;
  obj.stand_at(place);
  for (const double x : {0.0, wide - board}) obj.box("oak", {x, 0, 0}, {x + board, tall, deep}, bottom);
  obj.box("oak", {board, 0, 0.004}, {wide - board, tall - 0.004, 0.016}, bottom | x_low | x_high);
  for (int shelf = 0; shelf < 5; ++shelf) {
    const double y = 0.06 + shelf * 0.36;
    obj.box("oak", {board, y, 0.016}, {wide - board, y + board, deep}, x_low | x_high | z_low);
    for (int binder = 0; binder < 14 - 2 * (shelf % 3); ++binder) {
      const double x = board + 0.01 + 0.078 * binder;
      obj.box(binder % 3 == 1 ? "paper" : "binder", {x, y + board, 0.03},
              {x + 0.07, y + board + 0.30, 0.28 - 0.01 * (binder % 4)}, bottom);
    }
  }
}

/// Adds a desk with its drawers, a screen and papers.
void add_desk(ObjWriter& obj, const Place& place) {
  add_table(obj, "oak", place, 1.6, 0.8, 0.73);
  obj.box("steel", {-0.70, 0.08, -0.30}, {-0.35, 0.66, 0.30});
  for (const double y : {0.10, 0.29, 0.48}) obj.box("paper", {-0.69, y, 0.30}, {-0.36, y + 0.17, 0.312}, z_low);
  obj.box("steel", {-0.12, 0.73, -0.24}, {0.12, 0.745, -0.06}, bottom);
  obj.box("steel", {-0.02, 0.745, -0.17}, {0.02, 0.90, -0.14}, bottom);
  obj.box("steel", {-0.30, 0.86, -0.14}, {0.30, 1.22, -0.11});
  obj.box("paper", {0.30, 0.73, 0.00}, {0.51, 0.734, 0.297}, bottom);
  obj.box("paper", {0.36, 0.734, 0.02}, {0.57, 0.75, 0.30}, bottom);
}

ObjWriter louvred_room() {
  ObjWriter obj;
  add_closed_room(obj, {width, height, depth});
  add_luminaire(obj, {1.6, 2.1});
  add_luminaire(obj, {3.6, 2.1});
  add_desk(obj, {1.5, 1.9});
  add_desk(obj, {3.7, 2.5, 180});
  add_chair(obj, "cloth", {1.5, 2.7, 180});
  add_chair(obj, "cloth", {3.7, 1.7});
  add_shelf(obj, {0.3, 0.01});
  add_shelf(obj, {1.55, 0.01});
  add_table(obj, "oak", {4.8, 0.5}, 0.5, 0.5, 0.55);
  add_shaded_lamp(obj, {.x = 4.8, .z = 0.5, .y = 0.55});
  return obj;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) {
  using namespace alvor::bench;
  return run_scene_program(count, arguments, "louvred_room", paints, louvred_room);
}
