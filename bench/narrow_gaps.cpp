// narrow_gaps DIR: writes three scenes in which light reaches part of a wall or ceiling only through a narrow gap: gap_panels (24
// panels 5 cm before the wall of a round room), gap_ceiling (a panel 1 cm below a ceiling) and gap_lamp (a lamp 1 cm below a
// ceiling), as .obj and .mtl. The output is always the same. Lengths are metres, y is up.

#include "bench/scene_program.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace alvor::bench {

namespace {

constexpr Paint paints[]{{"wall", "Kd 0.75 0.72 0.68"},
                         {"floor", "Kd 0.50 0.45 0.40"},
                         {"panel", "Kd 0.60 0.35 0.25"},
                         {"housing", "Kd 0.70 0.70 0.70"},
                         {"lamp", "Kd 0 0 0\nKe 10 10 10"}};

/// Adds a round room: `sides` walls of one polygon each, floor and ceiling.
void add_round_room(ObjWriter& obj, double radius, double height, int sides) {
  std::vector<int> low, high, high_turned;
  for (int side = 0; side < sides; ++side) {
    const double angle = 2 * std::numbers::pi * side / sides;
    const Vec3 at{radius * std::cos(angle), 0, -radius * std::sin(angle)};
    low.push_back(obj.vertex(at));
    high.push_back(obj.vertex({at.x, height, at.z}));
  }
  obj.face("floor", low);
  high_turned.assign(high.rbegin(), high.rend());
  obj.face("wall", high_turned);
  for (int side = 0; side < sides; ++side) {
    const auto a = static_cast<std::size_t>(side), b = static_cast<std::size_t>((side + 1) % sides);
    obj.face("wall", std::array{low[b], low[a], high[a], high[b]});
  }
}

/// Adds a lamp that shines upwards and downwards: the upper and lower face of a flat box.
void add_flat_lamp(ObjWriter& obj, Vec3 low, Vec3 high) {
  obj.box("lamp", low, high, x_low | x_high | z_low | z_high);
  obj.box("housing", low, high, bottom | top);
}

ObjWriter panels() {
  constexpr int count = 24;
  constexpr double radius = 2.5, height = 2.6, gap = 0.05, thick = 0.02;
  ObjWriter obj;
  obj.stand_at({});
  add_round_room(obj, radius, height, count);
  const double to_wall = radius * std::cos(std::numbers::pi / count);
  for (int panel = 0; panel < count; ++panel) {
    obj.stand_at({0, 0, 360.0 * (panel + 0.5) / count});
    obj.box("panel", {to_wall - gap - thick, 0.3, -0.24}, {to_wall - gap, 2.2, 0.24});
  }
  obj.stand_at({});
  add_flat_lamp(obj, {-0.3, 1.8, -0.3}, {0.3, 1.84, 0.3});
  return obj;
}

void add_box_room(ObjWriter& obj) {
  obj.stand_at({});
  obj.box("floor", {-2, 0, -1.5}, {2, 2.5, 1.5}, ~bottom, true);
  obj.box("wall", {-2, 0, -1.5}, {2, 2.5, 1.5}, bottom, true);
}

ObjWriter panel_below_ceiling() {
  ObjWriter obj;
  add_box_room(obj);
  obj.box("panel", {-1.2, 2.47, -0.9}, {0.6, 2.49, 0.9});
  add_flat_lamp(obj, {0.9, 1.2, -0.3}, {1.5, 1.24, 0.3});
  return obj;
}

ObjWriter lamp_below_ceiling() {
  ObjWriter obj;
  add_box_room(obj);
  add_flat_lamp(obj, {-0.6, 2.45, -0.4}, {0.6, 2.49, 0.4});
  return obj;
}

}  // namespace

}  // namespace alvor::bench

int main(int count, char** arguments) {
  using namespace alvor::bench;
  const int status = run_scene_program(count, arguments, "gap_panels", paints, panels);
  if (status != 0) return status;
  run_scene_program(count, arguments, "gap_ceiling", paints, panel_below_ceiling);
  return run_scene_program(count, arguments, "gap_lamp", paints, lamp_below_ceiling);
}
