#pragma once
// Scenes that tests share.

#include "meshing/scene.h"

#include <array>
#include <initializer_list>

namespace alvor::test {

inline void add_polygon(Scene& scene, std::initializer_list<Vec3> corners, std::uint32_t material = 0) {
  scene.add_polygon({corners.begin(), corners.size()}, material);
}

/// Adds six quads with normals pointing inwards (a room) or outwards (a solid). Faces: floor (y low), ceiling, x low, x high, z
/// low, z high.
inline void add_box(Scene& scene, Vec3 low, Vec3 high, bool inwards, std::array<std::uint32_t, 6> materials = {}) {
  const auto [x, y, z] = low;
  const auto [X, Y, Z] = high;
  const std::array<std::array<Vec3, 4>, 6> in{{{{{x, y, z}, {x, y, Z}, {X, y, Z}, {X, y, z}}},
                                               {{{x, Y, z}, {X, Y, z}, {X, Y, Z}, {x, Y, Z}}},
                                               {{{x, y, z}, {x, Y, z}, {x, Y, Z}, {x, y, Z}}},
                                               {{{X, y, z}, {X, y, Z}, {X, Y, Z}, {X, Y, z}}},
                                               {{{x, y, z}, {X, y, z}, {X, Y, z}, {x, Y, z}}},
                                               {{{x, y, Z}, {x, Y, Z}, {X, Y, Z}, {X, y, Z}}}}};
  for (std::size_t f = 0; f < 6; ++f) {
    const auto& c = in[f];
    if (inwards) add_polygon(scene, {c[0], c[1], c[2], c[3]}, materials[f]);
    else add_polygon(scene, {c[3], c[2], c[1], c[0]}, materials[f]);
  }
}

/// Adds the triangle a, b, c of the unit sphere, moved to a sphere, as 4^`levels` triangles.
inline void add_part_of_globe(Scene& scene, Vec3 centre, double radius, std::array<Vec3, 3> corners, int levels,
                              std::uint32_t material) {
  const auto [a, b, c] = corners;
  const auto at = [&](Vec3 p) { return centre + radius * p; };
  if (levels == 0) return add_polygon(scene, {at(a), at(b), at(c)}, material);
  const Vec3 ab = normalized(a + b), bc = normalized(b + c), ca = normalized(c + a);
  for (const std::array<Vec3, 3>& part : {std::array{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}})
    add_part_of_globe(scene, centre, radius, part, levels - 1, material);
}

/// Adds a sphere of 8 * 4^`levels` triangles whose fronts look outwards.
inline void add_globe(Scene& scene, Vec3 centre, double radius, int levels, std::uint32_t material) {
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) {
        std::array<Vec3, 3> corners{{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
        if (x * y * z < 0) corners = {corners[0], corners[2], corners[1]};
        add_part_of_globe(scene, centre, radius, corners, levels, material);
      }
}

inline Material grey(double emission, double reflectance) {
  return {"grey", {emission, emission, emission}, {reflectance, reflectance, reflectance}, false};
}

/// Returns a closed room in which every surface has the same emission and reflectance.
inline Scene furnace(double emission, double reflectance) {
  Scene scene;
  scene.materials.push_back(grey(emission, reflectance));
  add_box(scene, {0, 0, 0}, {3, 2, 4}, true);
  return scene;
}

/// Returns a closed room with a lamp at the ceiling, a block on the floor and one red wall.
inline Scene coloured_room() {
  Scene scene;
  scene.materials = {grey(0, 0.7), grey(50, 0), {"red", {}, {0.6, 0.1, 0.05}, false}};
  add_box(scene, {0, 0, 0}, {4, 3, 5}, true, {0, 0, 2, 0, 0, 0});
  add_box(scene, {1, 0, 1}, {2, 1, 3}, false);
  add_polygon(scene, {{1.5, 2.99, 2}, {2.5, 2.99, 2}, {2.5, 2.99, 3}, {1.5, 2.99, 3}}, 1);
  return scene;
}

/// Returns coloured_room() with a second block, turned so that its outline crosses patches of all levels.
inline Scene room_with_contacts() {
  Scene scene = coloured_room();
  const std::size_t first = scene.vertices.size();
  add_box(scene, {2.5, 0, 1}, {3.3, 1.5, 1.8}, false);
  const Vec3 axis{2.9, 0, 1.4};
  for (std::size_t v = first; v < scene.vertices.size(); ++v) {
    const Vec3 d = scene.vertices[v] - axis;
    scene.vertices[v] = axis + Vec3{0.9 * d.x - 0.4 * d.z, d.y, 0.4 * d.x + 0.9 * d.z};
  }
  return scene;
}

/// Returns room_with_contacts() whose blocks and lamp are objects.
inline Scene room_of_objects() {
  Scene scene = room_with_contacts();
  for (std::size_t n = 0; n < scene.materials.size(); ++n) scene.materials[n].name = "m" + std::to_string(n);
  scene.objects = {{.name = "block", .first_face = 6, .face_count = 6},
                   {.name = "lamp", .first_face = 12, .face_count = 1},
                   {.name = "box", .first_face = 13, .face_count = 6}};
  return scene;
}

/// Returns the scene with all reflectances 0.
inline Scene black(Scene scene) {
  for (Material& material : scene.materials) material.reflectance = {};
  return scene;
}

}  // namespace alvor::test
