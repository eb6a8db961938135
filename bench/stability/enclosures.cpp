#include "bench/stability/enclosures.h"

namespace alvor::bench {

namespace {

/// Adds the wall between two rooms, seen from both: beside the door on both sides, and above it.
void add_wall_with_door(Scene& scene, double x, std::uint32_t material) {
  constexpr double left = 0.4, right = 0.6, top = 0.4;
  add_quad(scene, {x, 0, 0}, {x, 1, 0}, {x, 1, left}, {x, 0, left}, material);
  add_quad(scene, {x, 0, right}, {x, 1, right}, {x, 1, 1}, {x, 0, 1}, material);
  add_quad(scene, {x, top, left}, {x, 1, left}, {x, 1, right}, {x, top, right}, material);
}

}  // namespace

void add_quad(Scene& scene, Vec3 a, Vec3 b, Vec3 c, Vec3 d, std::uint32_t material) {
  scene.add_polygon(std::array{a, b, c, d}, material);
}

void add_room(Scene& scene, Vec3 low, Vec3 high, const BoxMaterials& materials) {
  test::add_box(scene, low, high, true, materials);
}

void add_block(Scene& scene, Vec3 low, Vec3 high, const BoxMaterials& materials) {
  test::add_box(scene, low, high, false, materials);
}

Scene unit_cube(const Material& floor, const Material& rest) {
  Scene scene;
  scene.materials = {floor, rest};
  add_room(scene, {0, 0, 0}, {1, 1, 1}, {0, 1, 1, 1, 1, 1});
  return scene;
}

Scene facing_plates(double distance, double reflectance) {
  Scene scene;
  scene.materials = {grey(1, reflectance), grey(0, reflectance)};
  add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}, 0);
  add_quad(scene, {0, distance, 0}, {1, distance, 0}, {1, distance, 1}, {0, distance, 1}, 1);
  return scene;
}

Scene chain_of_rooms(int count, double reflectance) {
  Scene scene;
  scene.materials = {grey(0, reflectance), grey(1, reflectance), grey(0, reflectance)};
  scene.materials[2].two_sided = true;
  for (int room = 0; room < count; ++room) {
    const double x = room, X = room + 1;
    add_quad(scene, {x, 0, 0}, {x, 0, 1}, {X, 0, 1}, {X, 0, 0});
    add_quad(scene, {x, 1, 0}, {X, 1, 0}, {X, 1, 1}, {x, 1, 1}, room == 0 ? 1 : 0);
    add_quad(scene, {x, 0, 0}, {X, 0, 0}, {X, 1, 0}, {x, 1, 0});
    add_quad(scene, {x, 0, 1}, {x, 1, 1}, {X, 1, 1}, {X, 0, 1});
    if (room > 0) add_wall_with_door(scene, x, 2);
  }
  const double end = count;
  add_quad(scene, {0, 0, 0}, {0, 1, 0}, {0, 1, 1}, {0, 0, 1});
  add_quad(scene, {end, 0, 0}, {end, 0, 1}, {end, 1, 1}, {end, 1, 0});
  return scene;
}

Scene placed(Scene scene, double scale, Vec3 offset) {
  for (Vec3& vertex : scene.vertices) vertex = scale * vertex + offset;
  return scene;
}

}  // namespace alvor::bench
