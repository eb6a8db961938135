#include "bench/stability/enclosures.h"

namespace alvor::bench {

namespace {

std::array<std::array<Vec3, 4>, 6> faces_of_room(Vec3 low, Vec3 high) {
  const auto [x, y, z] = low;
  const auto [X, Y, Z] = high;
  return {{{{{x, y, z}, {x, y, Z}, {X, y, Z}, {X, y, z}}},
           {{{x, Y, z}, {X, Y, z}, {X, Y, Z}, {x, Y, Z}}},
           {{{x, y, z}, {x, Y, z}, {x, Y, Z}, {x, y, Z}}},
           {{{X, y, z}, {X, y, Z}, {X, Y, Z}, {X, Y, z}}},
           {{{x, y, z}, {X, y, z}, {X, Y, z}, {x, Y, z}}},
           {{{x, y, Z}, {x, Y, Z}, {X, Y, Z}, {X, y, Z}}}}};
}

/// Between two rooms, seen from both: beside the door, on both sides, and above it.
void add_wall_with_door(Scene& scene, double x, std::uint32_t material) {
  constexpr double left = 0.4, right = 0.6, top = 0.4;
  add_quad(scene, {x, 0, 0}, {x, 1, 0}, {x, 1, left}, {x, 0, left}, material);
  add_quad(scene, {x, 0, right}, {x, 1, right}, {x, 1, 1}, {x, 0, 1}, material);
  add_quad(scene, {x, top, left}, {x, 1, left}, {x, 1, right}, {x, top, right}, material);
}

}  // namespace

Material grey(double emission, double reflectance) {
  return {"grey", {emission, emission, emission}, {reflectance, reflectance, reflectance}, false};
}

void add_polygon(Scene& scene, std::span<const Vec3> corners, std::uint32_t material) {
  std::vector<std::uint32_t> ring;
  for (const Vec3& corner : corners) {
    ring.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back(corner);
  }
  scene.add_face(ring, material);
}

void add_quad(Scene& scene, Vec3 a, Vec3 b, Vec3 c, Vec3 d, std::uint32_t material) {
  add_polygon(scene, std::array{a, b, c, d}, material);
}

void add_room(Scene& scene, Vec3 low, Vec3 high, const BoxMaterials& materials) {
  const auto faces = faces_of_room(low, high);
  for (std::size_t f = 0; f < faces.size(); ++f) add_polygon(scene, faces[f], materials[f]);
}

void add_block(Scene& scene, Vec3 low, Vec3 high, const BoxMaterials& materials) {
  const auto faces = faces_of_room(low, high);
  for (std::size_t f = 0; f < faces.size(); ++f)
    add_quad(scene, faces[f][3], faces[f][2], faces[f][1], faces[f][0], materials[f]);
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
