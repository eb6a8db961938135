// furnished_room DIR: writes furnished_room.obj and .mtl, a closed room with two lamps and furniture. The output is always the
// same. Lengths are metres, y is up.

#include "bench/furniture.h"
#include "bench/scene_program.h"
#include "bench/walls.h"

#include <random>

namespace alvor::bench {

namespace {

constexpr Paint paints[]{{"wall", "Kd 0.78 0.74 0.66"},    {"ceiling", "Kd 0.86 0.86 0.84"}, {"floor", "Kd 0.45 0.30 0.18"},
                         {"oak", "Kd 0.58 0.42 0.26"},     {"walnut", "Kd 0.30 0.19 0.12"},  {"white", "Kd 0.80 0.80 0.78"},
                         {"blue", "Kd 0.14 0.24 0.46"},    {"rug", "Kd 0.52 0.16 0.13"},     {"brass", "Kd 0.60 0.47 0.22"},
                         {"canvas", "Kd 0.25 0.50 0.52"},  {"clay", "Kd 0.62 0.33 0.20"},    {"leaf", "Kd 0.16 0.40 0.12"},
                         {"book_1", "Kd 0.60 0.12 0.10"},  {"book_2", "Kd 0.12 0.34 0.22"},  {"book_3", "Kd 0.16 0.20 0.48"},
                         {"book_4", "Kd 0.72 0.58 0.20"},  {"book_5", "Kd 0.66 0.62 0.54"},  {"housing", "Kd 0.70 0.70 0.70"},
                         {"lamp", "Kd 0 0 0\nKe 14 13 11"}};

constexpr double width = 6, height = 2.7, depth = 4.6;

void add_books(ObjWriter& obj, std::minstd_rand& random, double from_x, double to_x, double shelf_y) {
  constexpr const char* colours[]{"book_1", "book_2", "book_3", "book_4", "book_5"};
  const auto between = [&](double low, double high) { return low + (high - low) * double(random() % 1000) / 1000; };
  for (double x = from_x + 0.01;;) {
    const double thick = between(0.03, 0.07), tall = between(0.20, 0.31), deep = between(0.15, 0.22);
    if (x + thick > to_x) return;
    obj.box(colours[random() % 5], {x, shelf_y, 0.04}, {x + thick, shelf_y + tall, 0.04 + deep}, bottom);
    x += thick + 0.002;
    if (random() % 9 == 0) x += between(0.08, 0.25);
  }
}

/// Adds a bookcase with its back at z = 0.
void add_bookcase(ObjWriter& obj, Place place) {
  constexpr double wide = 1.5, tall = 2.0, deep = 0.3, board = 0.025;
  obj.stand_at(place);
  for (const double x : {0.0, wide - board}) obj.box("oak", {x, 0, 0}, {x + board, tall, deep}, bottom);
  obj.box("oak", {board, 0, 0.005}, {wide - board, tall - 0.005, 0.02}, bottom | x_low | x_high);
  std::minstd_rand random(7);
  for (int shelf = 0; shelf < 6; ++shelf) {
    const double y = 0.08 + shelf * 0.376;
    obj.box("oak", {board, y, 0.02}, {wide - board, y + board, deep}, x_low | x_high | z_low);
    if (shelf < 5) add_books(obj, random, board, wide - board - 0.1 * (shelf % 3), y + board);
  }
}

/// Adds a cupboard with its back at z = 0.
void add_cupboard(ObjWriter& obj, Place place) {
  obj.stand_at(place);
  obj.box("white", {0, 0, 0}, {1.2, 1.0, 0.45}, bottom | top);
  obj.box("oak", {-0.02, 1.0, 0}, {1.22, 1.03, 0.48});
  for (const double x : {0.02, 0.61}) {
    obj.box("white", {x, 0.06, 0.45}, {x + 0.57, 0.97, 0.468}, z_low);
    obj.box("white", {x + 0.07, 0.13, 0.468}, {x + 0.50, 0.90, 0.474}, z_low);
    const double knob = x < 0.3 ? x + 0.525 : x + 0.015;
    obj.box("brass", {knob, 0.50, 0.468}, {knob + 0.03, 0.53, 0.50}, z_low);
  }
  obj.box("clay", {0.25, 1.03, 0.12}, {0.45, 1.20, 0.32}, bottom);
  obj.box("leaf", {0.20, 1.27, 0.07}, {0.50, 1.52, 0.37});
  obj.box("leaf", {0.335, 1.20, 0.205}, {0.365, 1.27, 0.235}, bottom | top);
  obj.box("book_4", {0.78, 1.03, 0.10}, {0.98, 1.06, 0.38}, bottom);
  obj.box("book_3", {0.80, 1.06, 0.12}, {0.97, 1.10, 0.35}, bottom);
}

/// Adds a door in the wall z = 0.
void add_door(ObjWriter& obj, Place place) {
  obj.stand_at(place);
  for (const double x : {0.0, 0.90}) obj.box("oak", {x, 0, 0}, {x + 0.08, 2.08, 0.035}, bottom | top | z_low);
  obj.box("oak", {-0.02, 2.08, 0}, {1.0, 2.17, 0.04}, z_low);
  obj.box("white", {0.085, 0.008, 0}, {0.895, 2.075, 0.015}, z_low);
  for (const double y : {0.15, 1.12}) obj.box("white", {0.20, y, 0.015}, {0.78, y + 0.80, 0.024}, z_low);
  obj.box("brass", {0.82, 1.0, 0.015}, {0.85, 1.03, 0.06}, z_low | z_high);
  obj.box("brass", {0.72, 0.995, 0.06}, {0.86, 1.035, 0.075});
}

/// Adds a picture on the wall z = 0.
void add_picture(ObjWriter& obj, Place place) {
  obj.stand_at(place);
  obj.box("walnut", {0, 1.62, 0}, {0.9, 2.22, 0.03}, z_low);
  obj.box("canvas", {0.05, 1.67, 0.03}, {0.85, 2.17, 0.034}, z_low);
}

/// Adds a sofa that faces +z, with its back at z = 0.
void add_sofa(ObjWriter& obj, Place place) {
  obj.stand_at(place);
  for (const double x : {0.0, 1.7}) obj.box("blue", {x, 0, 0}, {x + 0.2, 0.62, 0.9}, bottom);
  obj.box("blue", {0.2, 0, 0}, {1.7, 0.85, 0.22}, bottom);
  obj.box("blue", {0.2, 0, 0.22}, {1.7, 0.30, 0.86}, bottom | x_low | x_high | z_low);
  for (const double x : {0.21, 0.955}) obj.box("blue", {x, 0.30, 0.23}, {x + 0.735, 0.45, 0.88}, bottom);
  for (const double x : {0.21, 0.955}) obj.box("blue", {x, 0.455, 0.23}, {x + 0.735, 0.90, 0.36});
}

/// Adds five chairs around the table.
void add_chairs(ObjWriter& obj) {
  const Place places[]{{1.9, 2.0}, {1.9, 3.42, 180}, {2.7, 2.0}, {2.7, 3.42, 160}, {1.05, 2.7, 90}};
  int number = 0;
  for (const Place& place : places) {
    obj.object("chair.00" + std::to_string(++number));
    add_chair(obj, "walnut", place);
  }
}

ObjWriter furnished_room() {
  ObjWriter obj;
  obj.object("room");
  add_closed_room(obj, {width, height, depth});
  obj.object("lamp.001");
  add_lamp(obj, {2.5, height, 2.6}, 1.4, 0.3);
  obj.object("lamp.002");
  add_lamp(obj, {4.7, height, 2.6}, 0.6, 0.6);
  obj.object("bookcase");
  add_bookcase(obj, {0.3, 0.02});
  obj.object("cupboard");
  add_cupboard(obj, {2.3, 0.02});
  obj.object("picture");
  add_picture(obj, {2.45, 0});
  obj.object("door");
  add_door(obj, {4.2, 0});
  obj.object("table");
  add_table(obj, "oak", {2.3, 2.7}, 1.7, 0.9, 0.75);
  add_chairs(obj);
  obj.object("bowl");
  obj.stand_at({2.3, 2.7});
  obj.box("clay", {-0.12, 0.75, -0.12}, {0.12, 0.83, 0.12}, bottom);
  obj.object("sofa");
  add_sofa(obj, {5.96, 1.6, -90});
  obj.object("rug");
  obj.stand_at({4.45, 2.55});
  obj.box("rug", {-0.55, 0, -1.1}, {0.55, 0.012, 1.1}, bottom);
  obj.object("side_table");
  add_table(obj, "oak", {3.75, 0.8}, 0.45, 0.45, 0.5);
  obj.object("low_table");
  add_table(obj, "oak", {.x = 4.45, .z = 2.55, .y = 0.012}, 0.5, 1.0, 0.42);
  return obj;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) {
  using namespace alvor::bench;
  return run_scene_program(count, arguments, "furnished_room", paints, furnished_room);
}
