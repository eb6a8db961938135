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

}  // namespace alvor::test
