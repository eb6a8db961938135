// cabinets DIR: writes cabinets.obj and .mtl, a room that is lit by three globes of 480 faces each. The doors of its
// cabinets are open and hang 3 mm before them; boards stand 1 to 50 mm apart; one picture is there twice. The output is always
// the same. Lengths are metres, y is up.

#include "bench/furniture.h"
#include "bench/scene_program.h"
#include "bench/walls.h"

#include <array>
#include <cmath>
#include <numbers>

namespace alvor::bench {

namespace {

constexpr Paint paints[]{{"wall", "Kd 0.74 0.72 0.68"},  {"ceiling", "Kd 0.85 0.85 0.83"},        {"floor", "Kd 0.38 0.30 0.22"},
                         {"oak", "Kd 0.58 0.44 0.30"},   {"white", "Kd 0.82 0.82 0.80"},          {"linen", "Kd 0.70 0.66 0.58"},
                         {"book", "Kd 0.46 0.18 0.16"},  {"steel", "Kd 0.45 0.46 0.48"},          {"cloth", "Kd 0.22 0.30 0.36"},
                         {"print", "Kd 0.30 0.48 0.52"}, {"globe", "Kd 0.2 0.2 0.2\nKe 60 56 50"}};

constexpr double width = 4.6, height = 2.7, depth = 3.8;

/// Adds a ball of emitting faces, `around` times `along` of them, and the rod by which it hangs and which ends in it.
void add_globe(ObjWriter& obj, const Place& place, double radius) {
  constexpr int around = 30, along = 16;
  obj.numbered_object("globe");
  obj.stand_at(place);
  std::array<std::array<int, around>, along - 1> rings{};
  for (std::size_t ring = 0; ring < rings.size(); ++ring)
    for (std::size_t n = 0; n < around; ++n) {
      const double polar = std::numbers::pi * double(ring + 1) / along, angle = 2 * std::numbers::pi * double(n) / around;
      rings[ring][n] = obj.vertex(
          {radius * std::sin(polar) * std::cos(angle), radius * std::cos(polar), -radius * std::sin(polar) * std::sin(angle)});
    }
  const int pole = obj.vertex({0, radius, 0}), other_pole = obj.vertex({0, -radius, 0});
  for (std::size_t n = 0; n < around; ++n) {
    const std::size_t next = (n + 1) % around;
    obj.face("globe", std::array{pole, rings.front()[n], rings.front()[next]});
    for (std::size_t ring = 0; ring + 1 < rings.size(); ++ring)
      obj.face("globe", std::array{rings[ring][n], rings[ring + 1][n], rings[ring + 1][next], rings[ring][next]});
    obj.face("globe", std::array{other_pole, rings.back()[next], rings.back()[n]});
  }
  obj.box("steel", {-0.006, 0.9 * radius, -0.006}, {0.006, height - place.y, 0.006}, top | bottom);
}

/// Adds a door from its hinge, the vertical edge at `place`, along x. The handle is on the side towards z: inside the cabinet
/// if the hinge is its right edge.
void add_door(ObjWriter& obj, const Place& place, double wide, double low, double high) {
  constexpr double thick = 0.018;
  obj.stand_at(place);
  obj.box("white", {0, low, 0}, {wide, high, thick});
  obj.box("steel", {wide - 0.06, 1.0, thick}, {wide - 0.04, 1.14, thick + 0.02}, z_low);
}

/// Adds a cabinet with its back at z = 0 that looks along +z, its shelves full, its two doors open. The doors are 3 mm before it.
void add_cabinet(ObjWriter& obj, const Place& place, double left_degrees, double right_degrees) {
  constexpr double wide = 1.1, tall = 2.0, deep = 0.42, board = 0.019, gap = 0.003;
  obj.numbered_object("cabinet");
  obj.stand_at(place);
  for (const double x : {0.0, wide - board}) obj.box("oak", {x, 0, 0}, {x + board, tall, deep}, bottom);
  obj.box("oak", {board, 0, 0.004}, {wide - board, tall - board, 0.012}, bottom | x_low | x_high);
  obj.box("oak", {board, tall - board, 0.004}, {wide - board, tall, deep}, x_low | x_high);
  for (int shelf = 0; shelf < 5; ++shelf) {
    const double y = 0.08 + 0.37 * shelf;
    obj.box("oak", {board, y, 0.012}, {wide - board, y + board, deep - 0.01}, x_low | x_high | z_low);
    for (int thing = 0; thing < 4; ++thing) {
      const double x = 0.05 + 0.26 * thing, size = 0.14 + 0.05 * ((thing + shelf) % 3);
      const char* const material = (thing + shelf) % 2 == 0 ? "linen" : "book";
      obj.box(material, {x, y + board, 0.05}, {x + 0.20, y + board + size, 0.32 - 0.03 * (thing % 3)}, bottom);
    }
  }
  add_door(obj, placed_in(place, {.x = 0, .z = deep + gap, .turn_degrees = -left_degrees}), wide / 2 - gap, 0.06, tall);
  add_door(obj, placed_in(place, {.x = wide, .z = deep + gap + 0.018, .turn_degrees = 180 + right_degrees}), wide / 2 - gap, 0.06,
           tall);
}

/// Adds boards that stand side by side, 1 to 50 mm apart.
void add_boards(ObjWriter& obj, const Place& place) {
  obj.numbered_object("boards");
  obj.stand_at(place);
  double x = 0;
  for (const double gap : {0.001, 0.002, 0.005, 0.01, 0.02, 0.05}) {
    obj.box("oak", {x, 0, 0}, {x + 0.02, 0.8, 0.5}, bottom);
    x += 0.02 + gap;
  }
  obj.box("oak", {x, 0, 0}, {x + 0.02, 0.8, 0.5}, bottom);
}

/// Adds a picture 2 mm before the wall z = 0, once more in the same place.
void add_picture_twice(ObjWriter& obj) {
  obj.stand_at({});
  for (int copy = 0; copy < 2; ++copy) {
    const std::array corners{obj.vertex({1.9, 1.3, 0.002}), obj.vertex({2.7, 1.3, 0.002}), obj.vertex({2.7, 1.9, 0.002}),
                             obj.vertex({1.9, 1.9, 0.002})};
    obj.numbered_object("picture");
    obj.face("print", corners);
  }
}

ObjWriter cabinets() {
  ObjWriter obj;
  add_closed_room(obj, {width, height, depth});
  add_globe(obj, {.x = 1.3, .z = 1.9, .y = 2.1}, 0.14);
  add_globe(obj, {.x = 2.9, .z = 1.6, .y = 2.2}, 0.10);
  add_globe(obj, {.x = 3.9, .z = 3.1, .y = 1.7}, 0.09);
  add_cabinet(obj, {.x = 0.5, .z = 0.01}, 105, 60);
  add_cabinet(obj, {.x = 3.1, .z = 0.01}, 80, 20);
  add_boards(obj, {.x = 0.02, .z = 3.2});
  add_picture_twice(obj);
  obj.numbered_object("table");
  add_table(obj, "oak", {1.6, 2.4}, 1.2, 0.8, 0.74);
  obj.numbered_object("chair");
  add_chair(obj, "cloth", {1.6, 3.1, 180});
  obj.numbered_object("chair");
  add_chair(obj, "cloth", {2.6, 2.4, 90});
  return obj;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) {
  using namespace alvor::bench;
  return run_scene_program(count, arguments, "cabinets", paints, cabinets);
}
