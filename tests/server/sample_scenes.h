#pragma once
// Small scenes for tests.

#include "meshing/scene.h"

#include <array>

namespace alvor {

/// Returns a strip of `count` unit squares that share no vertices, of one material that emits and reflects half.
inline Scene squares(std::uint32_t count) {
  Scene scene;
  scene.materials.push_back({"lamp", {1, 2, 3}, {0.5, 0.5, 0.5}, false});
  for (std::uint32_t i = 0; i < count; ++i) {
    const double x = 2.0 * i;
    scene.vertices.insert(scene.vertices.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x + 1, 1, 0}, {x, 1, 0}});
    scene.add_face(std::array{4 * i, 4 * i + 1, 4 * i + 2, 4 * i + 3}, 0);
  }
  return scene;
}

/// A scene that must be refused, and the text of the refusal.
struct BadScene {
  Scene scene;
  std::string reason;
};

inline BadScene bad_scene(const std::string& reason, void (*spoil)(Scene&)) {
  BadScene bad{squares(3), reason};
  spoil(bad.scene);
  return bad;
}

inline std::vector<BadScene> bad_scenes() {
  return {
      bad_scene("scene: has no faces", [](Scene& s) { s.faces.clear(); }),
      bad_scene("material 0 'lamp': reflectance 1.01 is outside [0, 1)", [](Scene& s) { s.materials[0].reflectance.g = 1.01; }),
      bad_scene("material 0 'lamp': reflectance nan is outside [0, 1)", [](Scene& s) { s.materials[0].reflectance.r = NAN; }),
      bad_scene("material 0 'lamp': emission -1 is not a finite value >= 0", [](Scene& s) { s.materials[0].emission.b = -1; }),
      bad_scene("vertex 5: coordinate inf is not finite", [](Scene& s) { s.vertices[5].y = INFINITY; }),
      bad_scene("vertex 5: coordinate 2e+09 is beyond 1e9 m", [](Scene& s) { s.vertices[5].y = 2e9; }),
      bad_scene("face 1: vertex index 99 is out of range, there are 12 vertices", [](Scene& s) { s.corners[5] = 99; }),
      bad_scene("face 2: material index 7 is out of range, there are 1 materials", [](Scene& s) { s.faces[2].material = 7; }),
      bad_scene("scene: all of its faces are degenerate",
                [](Scene& s) {
                  for (Vec3& v : s.vertices) v.y = 0;
                }),
  };
}

}  // namespace alvor
