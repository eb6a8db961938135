#pragma once
// Scenes that exercise different parts of a solve.

#include "tests/scenes.h"

namespace alvor::test {

inline Scene room_with_many_lamps() {
  Scene scene = coloured_room();
  for (int n = 0; n < 20; ++n) {
    const double x = 0.15 * n + 0.2, X = x + 0.1;
    add_polygon(scene, {{x, 2.9, 4}, {X, 2.9, 4}, {X, 2.9, 4.1}, {x, 2.9, 4.1}}, 1);
  }
  return scene;
}

/// Returns a room with a sphere lamp and a spot, into which the sun shines through the missing ceiling.
inline Scene room_with_lamps_and_sun() {
  Scene scene = coloured_room();
  scene.faces.erase(scene.faces.begin() + 1);
  Light lamp{"bulb", LightKind::point, {9, 8, 7}, {3, 2, 4}},
      spot{"spot", LightKind::spot, {50, 50, 20}, {0.5, 2.5, 0.5}, {0, -1, 0}};
  lamp.radius = 0.1;
  Light sun{"sun", LightKind::directional, {60, 60, 50}};
  sun.direction = normalized(Vec3{0.5, -1, 0.2});
  sun.angular_diameter = 0.0093;
  scene.lights = {lamp, spot, sun};
  return scene;
}

/// Returns a room of 4 x 3 x 5 m with a window of 2 x 1.5 m in a wall 0.4 m thick. Face 0 is the floor.
inline Scene room_with_deep_window(double reflectance) {
  Scene scene;
  scene.materials = {grey(0, reflectance)};
  add_polygon(scene, {{0, 0, 0}, {0, 0, 5}, {4, 0, 5}, {4, 0, 0}});
  add_polygon(scene, {{0, 3, 0}, {4, 3, 0}, {4, 3, 5}, {0, 3, 5}});
  add_polygon(scene, {{0, 0, 0}, {0, 3, 0}, {0, 3, 5}, {0, 0, 5}});
  add_polygon(scene, {{4, 0, 0}, {4, 0, 5}, {4, 3, 5}, {4, 3, 0}});
  add_polygon(scene, {{0, 0, 5}, {0, 3, 5}, {4, 3, 5}, {4, 0, 5}});
  // The wall's inner side about the window, and the window's reveals.
  add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}});
  add_polygon(scene, {{0, 2.5, 0}, {4, 2.5, 0}, {4, 3, 0}, {0, 3, 0}});
  add_polygon(scene, {{0, 1, 0}, {1, 1, 0}, {1, 2.5, 0}, {0, 2.5, 0}});
  add_polygon(scene, {{3, 1, 0}, {4, 1, 0}, {4, 2.5, 0}, {3, 2.5, 0}});
  constexpr double out = -0.4;
  add_polygon(scene, {{1, 1, 0}, {3, 1, 0}, {3, 1, out}, {1, 1, out}});
  add_polygon(scene, {{1, 2.5, out}, {3, 2.5, out}, {3, 2.5, 0}, {1, 2.5, 0}});
  add_polygon(scene, {{1, 1, out}, {1, 2.5, out}, {1, 2.5, 0}, {1, 1, 0}});
  add_polygon(scene, {{3, 1, 0}, {3, 2.5, 0}, {3, 2.5, out}, {3, 1, out}});
  return scene;
}

/// Returns the same room under an overcast sky. Its reveals look for the sky in all directions, its other faces through the
/// window.
inline Scene room_under_overcast_sky() {
  Scene scene = room_with_deep_window(0.5);
  Light sky{"sky", LightKind::sky, {1000, 1000, 1000}};
  sky.direction = {0, -1, 0};
  sky.sky = cie_sky(1, normalized(Vec3{0.5, 0.7, -0.6}));
  scene.lights = {sky};
  return scene;
}

inline Scene black_room() { return black(room_with_contacts()); }

inline Scene hazy_room() {
  Scene scene = room_with_contacts();
  scene.absorption = {0.01, 0.1, 0.05};
  return scene;
}

/// Returns a room with a floor of 625 tiles, more faces than a coarse grid has units.
inline Scene tiled_room() {
  Scene scene = coloured_room();
  scene.faces.erase(scene.faces.begin());
  for (int i = 0; i < 25; ++i)
    for (int j = 0; j < 25; ++j) {
      const double x = 4.0 * i / 25, z = 5.0 * j / 25, X = 4.0 * (i + 1) / 25, Z = 5.0 * (j + 1) / 25;
      add_polygon(scene, {{x, 0, z}, {x, 0, Z}, {X, 0, Z}, {X, 0, z}}, 0);
    }
  return scene;
}

/// Returns a room with a curtain that lets light through diffusely.
inline Scene curtained_room() {
  Scene scene = coloured_room();
  Material curtain = grey(0, 0.4);
  curtain.two_sided = true;
  curtain.diffuse_transmittance = {0.3, 0.4, 0.3};
  scene.materials.push_back(curtain);
  add_polygon(scene, {{3, 0.5, 0.5}, {3, 2.5, 0.5}, {3, 2.5, 4.5}, {3, 0.5, 4.5}}, 3);
  return scene;
}

/// Returns two rooms of 4 x 3 x 4 m with lamps, 6 m apart, and a box of half a metre in the first one.
inline Scene two_rooms() {
  Scene scene;
  scene.materials = {grey(0, 0.5), grey(1, 0)};
  for (const double x : {0.0, 10.0}) {
    add_box(scene, {x, 0, 0}, {x + 4, 3, 4}, true);
    add_polygon(scene, {{x + 1, 2.9, 1}, {x + 2, 2.9, 1}, {x + 2, 2.9, 2}, {x + 1, 2.9, 2}}, 1);
    add_polygon(scene, {{x + 3, 2.9, 1}, {x + 3.5, 2.9, 1}, {x + 3.5, 2.9, 2}, {x + 3, 2.9, 2}}, 1);
  }
  scene.objects = {{.name = "box", .first_face = static_cast<std::uint32_t>(scene.faces.size()), .face_count = 6}};
  add_box(scene, {1, 0.5, 1}, {1.5, 1, 1.5}, false);
  return scene;
}

}  // namespace alvor::test
