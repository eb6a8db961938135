#include "client/quad_pairing.h"

#include "tests/client/faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace alvor {
namespace {

/// n x n unit squares in the xy plane, each cut in two, in the order of `order`.
Scene cut_grid(std::uint32_t n, std::span<const std::uint32_t> order) {
  Scene scene;
  scene.materials.resize(1);
  for (std::uint32_t v = 0; v < (n + 1) * (n + 1); ++v) scene.vertices.push_back({double(v % (n + 1)), double(v / (n + 1)), 0});
  for (const std::uint32_t t : order) {
    const std::uint32_t a = t / 2 / n * (n + 1) + t / 2 % n, b = a + 1, c = b + n + 1, d = a + n + 1;
    if (t % 2 == 0) scene.add_face(std::vector{a, b, c}, 0);
    else scene.add_face(std::vector{c, d, a}, 0);
  }
  return scene;
}

TEST(QuadPairing, AGridBecomesItsSquaresInWhateverOrderItsTrianglesCome) {
  std::vector<std::uint32_t> order(2 * 30 * 30);
  std::iota(order.begin(), order.end(), 0u);
  for (int shuffle = 0; shuffle < 2; ++shuffle) {
    Scene scene = cut_grid(30, order);
    pair_triangles(scene);
    EXPECT_EQ(corner_counts(scene), std::vector<std::uint32_t>(30 * 30, 4));
    for (std::size_t f = 0; f < scene.faces.size(); ++f) EXPECT_EQ(area_vector(scene, f), (Vec3{0, 0, 1}));
    std::ranges::shuffle(order, std::mt19937(1));
  }
}

/// Faces left of a square cut along its diagonal, after its last corner and the second triangle's material were changed.
std::size_t faces_of_cut_square(Vec3 last_corner, std::uint32_t second_material) {
  Scene scene;
  scene.materials.resize(2);
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, last_corner};
  scene.add_face(std::vector<std::uint32_t>{0, 1, 2}, 0);
  scene.add_face(std::vector<std::uint32_t>{0, 2, 3}, second_material);
  pair_triangles(scene);
  return scene.faces.size();
}

TEST(QuadPairing, OnlyFlatConvexStoutPairsOfOneMaterialAreJoined) {
  EXPECT_EQ(faces_of_cut_square({0, 1, 0}, 0), 1u);
  EXPECT_EQ(faces_of_cut_square({0, 1, 0}, 1), 2u);      // two materials
  EXPECT_EQ(faces_of_cut_square({0, 1, 0.01}, 0), 2u);   // bent
  EXPECT_EQ(faces_of_cut_square({0.6, 0.7, 0}, 0), 2u);  // a corner of nearly 180 degrees
  EXPECT_EQ(faces_of_cut_square({-1, -0.1, 0}, 0), 2u);  // concave
}

}  // namespace
}  // namespace alvor
