#include "bench/stability/awkward_scenes.h"

#include "bench/stability/enclosures.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace alvor::bench {

namespace {

constexpr double reflectance = 0.5;

Scene furnace() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  add_room(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

// Returns a furnace with one corner moved, and with it the three faces that meet there.
Scene bent(double by) {
  Scene scene = furnace();
  for (Vec3& vertex : scene.vertices)
    if (vertex == Vec3{3, 2, 4}) vertex += {by, -0.7 * by, 0.4 * by};
  return scene;
}

}  // namespace

// Returns a room with a lamp in its ceiling and a block on its floor.
Scene lit_room() {
  Scene scene;
  scene.materials = {grey(0, 0.6), grey(50, 0)};
  add_room(scene, {0, 0, 0}, {4, 3, 5});
  add_block(scene, {1, 0, 1}, {2, 1, 3});
  add_quad(scene, {1.5, 2.99, 2}, {2.5, 2.99, 2}, {2.5, 2.99, 3}, {1.5, 2.99, 3}, 1);
  return scene;
}

Scene touching_blocks() {
  Scene scene = furnace();
  add_block(scene, {0.5, 0, 1}, {1, 1, 2});
  add_block(scene, {1, 0, 1}, {1.5, 0.5, 2});
  return scene;
}

Scene small_lamp_in_large_room() {
  Scene scene;
  scene.materials = {grey(0, reflectance), grey(1e12, reflectance)};
  add_room(scene, {0, 0, 0}, {1, 1, 1});
  constexpr double low = 0.5, high = 0.5 + 1e-6, level = 0.5;
  add_quad(scene, {low, level, low}, {high, level, low}, {high, level, high}, {low, level, high}, 1);
  return scene;
}

// Returns a furnace whose floor contains strips a millionth as wide as long, as quads and as triangles.
Scene slivers() {
  Scene scene = furnace();
  scene.faces.erase(scene.faces.begin());
  constexpr double width = 3e-6;
  add_quad(scene, {0, 0, 0}, {0, 0, 4}, {1, 0, 4}, {1, 0, 0});
  for (int strip = 0; strip < 10; ++strip) {
    const double x = 1 + strip * width, X = x + width;
    if (strip % 2) {
      add_quad(scene, {x, 0, 0}, {x, 0, 4}, {X, 0, 4}, {X, 0, 0});
    } else {
      scene.add_polygon(std::array<Vec3, 3>{{{x, 0, 0}, {x, 0, 4}, {X, 0, 4}}}, 0);
      scene.add_polygon(std::array<Vec3, 3>{{{x, 0, 0}, {X, 0, 4}, {X, 0, 0}}}, 0);
    }
  }
  const double last = 1 + 10 * width;
  add_quad(scene, {last, 0, 0}, {last, 0, 4}, {3, 0, 4}, {3, 0, 0});
  return scene;
}

Scene every_face_twice() {
  Scene scene = furnace();
  add_room(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

// Returns a furnace whose walls are two faces in one place, one seen from inside and one from outside.
Scene back_to_back() {
  Scene scene = furnace();
  add_block(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

Scene overlapping_coplanar() {
  Scene scene = furnace();
  add_quad(scene, {0.5, 0, 0.5}, {0.5, 0, 2.7}, {2.2, 0, 2.7}, {2.2, 0, 0.5});
  return scene;
}

Scene floors_a_hair_apart() {
  Scene scene = furnace();
  constexpr double hair = 4e-7;
  add_quad(scene, {0, hair, 0}, {0, hair, 4}, {3, hair, 4}, {3, hair, 0});
  return scene;
}

Scene block_a_hair_above_the_floor() {
  Scene scene = furnace();
  add_block(scene, {1, 4e-7, 1}, {2, 1, 2});
  return scene;
}

Scene crossing_blocks() {
  Scene scene = furnace();
  add_block(scene, {0.5, 0.3, 1}, {2, 1, 2});
  add_block(scene, {1, 0.5, 0.5}, {1.5, 1.5, 3});
  return scene;
}

Scene fan_on_one_edge() {
  constexpr int blades = 20;
  Scene scene = furnace();
  scene.materials.push_back(grey(1, reflectance));
  scene.materials[1].two_sided = true;
  for (int blade = 0; blade < blades; ++blade) {
    const double angle = 2 * std::numbers::pi * blade / blades, x = 1.5 + std::cos(angle), z = 2 + std::sin(angle);
    add_quad(scene, {1.5, 0.5, 2}, {x, 0.5, z}, {x, 1.5, z}, {1.5, 1.5, 2}, 1);
  }
  return scene;
}

// Returns two cones of 10 000 triangles each, base to base, seen from inside: closed and convex.
Scene cones() {
  constexpr std::uint32_t sides = 10'000;
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  scene.vertices = {{0, 1, 0}, {0, -1, 0}};
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * k / sides;
    scene.vertices.push_back({std::cos(angle), 0, std::sin(angle)});
  }
  for (std::uint32_t k = 0; k < sides; ++k) {
    const std::uint32_t a = 2 + k, b = 2 + (k + 1) % sides;
    scene.add_face(std::array<std::uint32_t, 3>{0, a, b}, 0);
    scene.add_face(std::array<std::uint32_t, 3>{1, b, a}, 0);
  }
  return scene;
}

Scene hardly_bent() { return bent(1e-4); }

Scene clearly_bent() { return bent(0.1); }

Scene with_degenerate_faces() {
  Scene scene = furnace();
  scene.add_polygon(std::array<Vec3, 3>{{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}}, 0);
  scene.add_polygon(std::array<Vec3, 3>{{{1, 1, 1}, {2, 1, 1}, {1.5, 1, 1}}}, 0);
  add_quad(scene, {1, 1, 1}, {2, 1, 1}, {2, 1, 1}, {1, 1, 1});
  return scene;
}

Scene inside_out() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  add_block(scene, {0, 0, 0}, {3, 2, 4});
  return scene;
}

Scene one_face() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  add_quad(scene, {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
  return scene;
}

Scene all_degenerate() {
  Scene scene;
  scene.materials = {grey(1, reflectance)};
  scene.add_polygon(std::array<Vec3, 3>{{{1, 1, 1}, {2, 1, 1}, {1.5, 1, 1}}}, 0);
  return scene;
}

Scene beyond_the_world() { return placed(furnace(), 1, {2e9, 0, 0}); }

Scene not_a_number() { return placed(furnace(), std::numeric_limits<double>::quiet_NaN()); }

}  // namespace alvor::bench
