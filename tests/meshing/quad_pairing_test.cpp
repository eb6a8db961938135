#include "meshing/quad_pairing.h"

#include "meshing/base_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace alvor {
namespace {

/// Returns n x n unit squares in the xy plane, each cut in two; the triangles come in the order of `order`.
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
    const BaseMesh mesh(cut_grid(30, order));
    EXPECT_EQ(mesh.roots().size(), 30u * 30u);
    for (const RootPatch& root : mesh.roots()) {
      EXPECT_EQ(root.corner_count, 4);
      EXPECT_EQ(root.normal * root.area, (Vec3{0, 0, 1}));
    }
    std::ranges::shuffle(order, std::mt19937(1));
  }
}

TEST(QuadPairing, EveryInputFaceIsToldByOneRoot) {
  std::vector<std::uint32_t> order(2 * 7 * 7);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::shuffle(order, std::mt19937(2));
  order.resize(order.size() - 5);  // some triangles have lost their other half
  const Scene scene = cut_grid(7, order);
  std::vector<int> told(scene.faces.size());
  const BaseMesh mesh(scene);
  for (const RootPatch& root : mesh.roots()) {
    ++told[root.input.first];
    EXPECT_EQ(root.input.second != InputFaces::none, root.corner_count == 4);
    if (root.input.second == InputFaces::none) continue;
    ++told[root.input.second];
    EXPECT_LT(root.input.first, root.input.second);
  }
  EXPECT_EQ(told, std::vector<int>(scene.faces.size(), 1));
}

TEST(QuadPairing, ASceneThatHasOtherFacesKeepsItsTriangles) {
  std::vector<std::uint32_t> order{0, 1};
  Scene scene = cut_grid(2, order);
  EXPECT_EQ(BaseMesh(scene).roots().size(), 1u);
  EXPECT_EQ(BaseMesh(scene, {.join_triangles = false}).roots().size(), 2u);
  scene.add_face(std::vector<std::uint32_t>{4, 5, 8, 7}, 0);
  EXPECT_EQ(BaseMesh(scene).roots().size(), 3u);
}

TEST(QuadPairing, PairsThatWouldBeCutAgainStayTriangles) {
  for (const double bend : {0.0, 1e-6, 2e-5, 6e-5}) {
    Scene scene;
    scene.materials.resize(1);
    scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, bend}, {0, 1, 0}};
    scene.add_face(std::vector<std::uint32_t>{0, 1, 3}, 0);
    scene.add_face(std::vector<std::uint32_t>{1, 2, 3}, 0);
    const BaseMesh mesh(scene);
    EXPECT_EQ(mesh.weld_report().split_faces, 0u) << bend;
    EXPECT_EQ(mesh.roots().size(), bend < 4e-6 ? 1u : 2u) << bend;
  }
}

/// Returns the number of roots of a square cut along its diagonal, with a changed last corner and second material.
std::size_t roots_of_cut_square(Vec3 last_corner, std::uint32_t second_material) {
  Scene scene;
  scene.materials.resize(2);
  scene.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, last_corner};
  scene.add_face(std::vector<std::uint32_t>{0, 1, 2}, 0);
  scene.add_face(std::vector<std::uint32_t>{0, 2, 3}, second_material);
  return BaseMesh(scene).roots().size();
}

TEST(QuadPairing, OnlyFlatConvexStoutPairsOfOneMaterialAreJoined) {
  EXPECT_EQ(roots_of_cut_square({0, 1, 0}, 0), 1u);
  EXPECT_EQ(roots_of_cut_square({0, 1, 0}, 1), 2u);      // two materials
  EXPECT_EQ(roots_of_cut_square({0, 1, 0.01}, 0), 2u);   // not planar
  EXPECT_EQ(roots_of_cut_square({0.6, 0.7, 0}, 0), 2u);  // has a corner of nearly 180 degrees
  EXPECT_EQ(roots_of_cut_square({-1, -0.1, 0}, 0), 2u);  // is concave
}

}  // namespace
}  // namespace alvor
