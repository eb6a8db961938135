#include "tests/random/random_flaws.h"

#include "tests/random/random_faces.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

namespace alvor::test {

namespace {

std::vector<Vec3> ring_of(const Scene& scene, const Face& face) {
  std::vector<Vec3> ring;
  for (const std::uint32_t vertex : scene.corners_of(face)) ring.push_back(scene.vertices[vertex]);
  return ring;
}

Face random_face(Dice& dice, const Scene& scene) { return scene.faces[dice.below(scene.faces.size())]; }
std::uint32_t random_material(Dice& dice, const Scene& scene) { return dice.below(scene.materials.size()); }

void add_sliver(Dice& dice, Scene& scene) {
  const Vec3 a = random_point(dice), b = random_point(dice);
  const Vec3 aside = dice.magnitude(1e-9, 1e-2) * random_point(dice);
  scene.add_polygon(std::array<Vec3, 3>{a, b, lerp(a, b, dice.between(0, 1)) + aside}, random_material(dice, scene));
}

void add_speck(Dice& dice, Scene& scene) {
  const double size = dice.magnitude(1e-7, 1e-3);
  const Vec3 at = random_point(dice), u = size * random_point(dice), v = size * random_point(dice);
  scene.add_polygon(std::array<Vec3, 4>{at, at + u, at + u + v, at + v}, random_material(dice, scene));
}

void add_degenerate(Dice& dice, Scene& scene) {
  const Vec3 a = random_point(dice), b = dice.happens(0.3) ? a : random_point(dice);
  const Vec3 c = dice.happens(0.5) ? b : lerp(a, b, dice.between(0, 1));
  scene.add_polygon(std::array<Vec3, 3>{a, b, c}, random_material(dice, scene));
}

/// Adds a quad with one corner out of its plane.
void add_bent(Dice& dice, Scene& scene) {
  const Vec3 at = random_point(dice), u = 0.5 * random_point(dice), v = 0.5 * random_point(dice);
  const Vec3 off = dice.magnitude(1e-8, 0.3) * random_point(dice);
  scene.add_polygon(std::array<Vec3, 4>{at, at + u, at + u + v + off, at + v}, random_material(dice, scene));
}

/// Adds a planar star of five to eight corners; some cross themselves.
void add_star(Dice& dice, Scene& scene) {
  const Vec3 at = random_point(dice), u = 0.5 * random_point(dice), v = 0.5 * random_point(dice);
  const std::uint32_t corners = 5 + dice.below(4), turns = dice.happens(0.2) ? 2 : 1;
  std::vector<Vec3> ring;
  for (std::uint32_t c = 0; c < corners; ++c) {
    const double angle = 2 * std::numbers::pi * turns * c / corners, radius = dice.between(0.2, 1);
    ring.push_back(at + radius * std::cos(angle) * u + radius * std::sin(angle) * v);
  }
  scene.add_polygon(ring, random_material(dice, scene));
}

/// Adds a face with the same corners as another, possibly reversed or starting at another corner.
void add_double(Dice& dice, Scene& scene) {
  const Face face = random_face(dice, scene);
  const auto corners = scene.corners_of(face);
  std::vector<std::uint32_t> ring(corners.begin(), corners.end());
  std::ranges::rotate(ring, ring.begin() + dice.below(ring.size()));
  if (dice.happens(0.5)) std::ranges::reverse(ring);
  scene.add_face(ring, random_material(dice, scene));
}

/// Adds a face that overlaps another in its plane, or at a tiny distance.
void add_coplanar(Dice& dice, Scene& scene) {
  auto ring = ring_of(scene, random_face(dice, scene));
  const Vec3 middle = lerp(ring[0], ring[2], dice.between(0.2, 0.8));
  const double size = dice.between(0.2, 1.2);
  const Vec3 hair = dice.happens(0.5) ? Vec3{} : dice.magnitude(1e-9, 1e-4) * random_point(dice);
  for (Vec3& corner : ring) corner = lerp(middle, corner, size) + hair;
  if (dice.happens(0.3)) std::ranges::reverse(ring);
  scene.add_polygon(ring, random_material(dice, scene));
}

/// Adds many faces on one edge.
void add_fan(Dice& dice, Scene& scene) {
  const Vec3 a = random_point(dice), b = random_point(dice);
  for (std::uint32_t n = 2 + dice.below(4); n > 0; --n)
    scene.add_polygon(std::array<Vec3, 3>{a, b, random_point(dice)}, random_material(dice, scene));
}

void add_unused_vertex(Dice& dice, Scene& scene) {
  scene.vertices.push_back(dice.one_of({1.0, 1e2, 1e9 / 1e6}) * random_point(dice));
}

using AddFlaw = void (*)(Dice&, Scene&);

}  // namespace

bool add_flaws(Dice& dice, Scene& scene) {
  static constexpr AddFlaw harmless[] = {add_sliver, add_speck, add_degenerate, add_bent, add_fan, add_unused_vertex};
  static constexpr AddFlaw overlapping[] = {add_star, add_double, add_coplanar};
  bool is_well_posed = true;
  for (std::uint32_t n = 1 + dice.below(4); n > 0; --n) {
    const bool overlaps = dice.happens(0.3);
    (overlaps ? dice.one_of(overlapping) : dice.one_of(harmless))(dice, scene);
    is_well_posed &= !overlaps;
  }
  return is_well_posed;
}

std::string add_fault(Dice& dice, Scene& scene) {
  const std::uint32_t vertex = dice.below(scene.vertices.size()), face = dice.below(scene.faces.size()),
                      material = dice.below(scene.materials.size());
  const std::string of_material = "material " + std::to_string(material) + " '" + scene.materials[material].name + "'";
  const std::string of_vertex = "vertex " + std::to_string(vertex), of_face = "face " + std::to_string(face);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  switch (dice.below(10)) {
    case 0: return scene.vertices[vertex].y = dice.one_of({nan, infinity, -1e10}), of_vertex;
    case 1: return scene.materials[material].reflectance.g = dice.one_of({1.0, -0.1, nan, infinity}), of_material;
    case 2: return scene.materials[material].emission.b = dice.one_of({-1.0, nan, infinity, 1e40, 1e300}), of_material;
    case 3: return scene.faces[face].material = static_cast<std::uint32_t>(scene.materials.size()) + dice.below(2), of_face;
    case 4: return scene.faces[face].corner_count = dice.below(3), of_face;
    case 5: return scene.faces[face].first_corner = dice.one_of({~0u, ~0u - 2, 1u << 30}), of_face;
    case 6: return scene.faces[face].corner_count = dice.one_of({~0u, 1u << 31}), of_face;
    case 7: return scene.corners[scene.faces[face].first_corner] = ~0u, of_face;
    case 8: return scene.absorption.r = dice.one_of({-1.0, nan, infinity}), "absorption";
    default: return scene.faces.clear(), "scene";
  }
}

}  // namespace alvor::test
