#pragma once
// Shared by tests of pictures: a wall, a camera that faces it, and pixels.

#include "client/picture/png_file.h"
#include "client/picture/render.h"
#include "tests/client/hand_made_mesh.h"

#include <array>

namespace alvor {

using Pixel = std::array<int, 3>;

inline Pixel pixel(const Image& image, int x, int y) {
  const auto at = static_cast<std::size_t>(3 * (y * image.width + x));
  return {image.rgb[at], image.rgb[at + 1], image.rgb[at + 2]};
}

/// Returns a camera straight in front of a 1 x 1 m wall, in the middle of a picture that shows 2 x 2 m.
inline Camera facing_wall(int pixels = 64) {
  Camera camera;
  camera.eye = {0.5, 0.5, 1};
  camera.target = {0.5, 0.5, 0};
  camera.vertical_fov_degrees = 90;
  camera.width = camera.height = pixels;
  return camera;
}

inline DisplayMesh wall(RgbF radiosity, int leaves_per_side = 1) {
  DisplayMesh mesh;
  add_wall(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, leaves_per_side, [=](const Vec3&) { return radiosity; });
  return mesh;
}

}  // namespace alvor
