#pragma once
// Textures for tests.

#include "meshing/scene.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <vector>

namespace alvor::test {

/// Returns an image of random texels.
inline ColourImage noise(std::uint32_t columns, std::uint32_t rows, std::uint32_t seed = 1) {
  std::mt19937 random(seed);
  ColourImage image{columns, rows, {}};
  for (std::size_t i = 0; i < 3 * image.texel_count(); ++i) image.texels.push_back(static_cast<std::uint8_t>(random() % 256));
  return image;
}

/// Returns an image of squares that are dark and light in turn.
inline ColourImage checkerboard(std::uint32_t squares, std::uint8_t dark, std::uint8_t light) {
  ColourImage image{squares, squares, {}};
  for (std::uint32_t row = 0; row < squares; ++row)
    for (std::uint32_t column = 0; column < squares; ++column)
      image.texels.insert(image.texels.end(), 3, (row + column) % 2 == 0 ? dark : light);
  return image;
}

inline Material textured(ColourImage image, const Rgb& factor = {1, 1, 1}, Wrap wrap = Wrap::repeat) {
  Material material{"textured", {}, factor * mean_surface(image).reflectance, false, {}, {}};
  material.texture = Texture{std::make_shared<const ColourImage>(std::move(image)), factor, wrap, wrap};
  return material;
}

/// Appends a face with new vertices and their texture points.
inline void add_textured(Scene& scene, const std::vector<Vec3>& corners, const std::vector<TexturePoint>& points,
                         std::uint32_t material) {
  std::vector<std::uint32_t> ring;
  for (const Vec3& corner : corners) {
    ring.push_back(static_cast<std::uint32_t>(scene.vertices.size()));
    scene.vertices.push_back(corner);
  }
  scene.add_face(ring, material, points);
}

/// Gives all corners a texture point, as a scene with textures needs it.
inline void complete_texture_points(Scene& scene) { scene.texture_points.resize(scene.corners.size()); }

}  // namespace alvor::test
