#include "tests/random/random_faces.h"

#include "tests/scenes.h"

namespace alvor::test {

namespace {

std::array<std::uint32_t, 6> six_materials(Dice& dice, const Scene& scene) {
  std::array<std::uint32_t, 6> materials;
  for (std::uint32_t& material : materials) material = dice.below(scene.materials.size());
  return materials;
}

void add_triangle(Dice& dice, Scene& scene) {
  const std::array<Vec3, 3> ring{random_point(dice), random_point(dice), random_point(dice)};
  scene.add_polygon(ring, dice.below(scene.materials.size()));
}

/// Adds a parallelogram, or a quad with corner 2 moved within its plane.
void add_quad(Dice& dice, Scene& scene) {
  const double size = dice.magnitude(0.01, 1);
  const Vec3 at = random_point(dice), u = size * (random_point(dice) - at), v = size * (random_point(dice) - at);
  const double stretch = dice.happens(0.5) ? 1 : dice.between(0.6, 2);
  scene.add_polygon(std::array<Vec3, 4>{at, at + u, at + stretch * (u + v), at + v}, dice.below(scene.materials.size()));
}

void add_soup(Dice& dice, Scene& scene) {
  const std::size_t count = 1 + dice.below(dice.happens(0.2) ? 40 : 8);
  for (std::size_t n = 0; n < count; ++n) dice.happens(0.5) ? add_triangle(dice, scene) : add_quad(dice, scene);
}

void add_solid(Dice& dice, Scene& scene, Vec3 low, Vec3 high) {
  const auto mix = [&](double a, double b) { return a + (b - a) * dice.between(0.05, 0.5); };
  const Vec3 from{mix(low.x, high.x), mix(low.y, high.y), mix(low.z, high.z)};
  const Vec3 to{mix(from.x, high.x), mix(from.y, high.y), mix(from.z, high.z)};
  add_box(scene, from, to, false, six_materials(dice, scene));
}

void add_room(Dice& dice, Scene& scene) {
  const double flat = dice.happens(0.7) ? dice.between(0.3, 1) : dice.magnitude(1e-3, 1);
  const Vec3 low{0, 0, 0}, high{1, dice.between(0.5, 1), flat};
  add_box(scene, low, high, true, six_materials(dice, scene));
  if (dice.happens(0.3)) scene.faces.erase(scene.faces.begin() + dice.below(6));  // opens the room
  for (std::uint32_t n = dice.below(4); n > 0; --n) add_solid(dice, scene, low, high);
}

void add_solids(Dice& dice, Scene& scene) {
  for (std::uint32_t n = 1 + dice.below(4); n > 0; --n) add_solid(dice, scene, {0, 0, 0}, {1, 1, 1});
}

}  // namespace

Vec3 random_point(Dice& dice) { return {dice.between(0, 1), dice.between(0, 1), dice.between(0, 1)}; }

void add_random_faces(Dice& dice, Scene& scene) {
  switch (dice.below(4)) {
    case 0: return add_soup(dice, scene);
    case 1: return add_solids(dice, scene);
    default: return add_room(dice, scene);
  }
}

}  // namespace alvor::test
