#include "meshing/leaf_gradient.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

TEST(LeafGradient, LinearFieldsAreReproducedOnAnyMesh) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  PatchForest forest(mesh);
  std::vector<NodeIndex> split;
  for (int n = 0; n < 60; ++n) forest.split(forest.leaves()[static_cast<std::size_t>(n * 7) % forest.leaf_count()], {}, split);
  const Vec3 slope{0.3, -0.2, 0.5};
  std::vector<Vec3> centre(forest.node_count());
  std::vector<Rgb> value(forest.node_count());
  const auto leaves = forest.leaves();
  for (const NodeIndex leaf : leaves) {
    const Uv c = forest.shape(leaf).centre();
    centre[leaf] = mesh.roots()[forest.id(leaf).root_face()].at(c.u, c.v);
    value[leaf] = (10 + dot(slope, centre[leaf])) * Rgb{1, 2, 3};
  }
  int with_full_slope = 0;
  for (const NodeIndex leaf : leaves) {
    const SmoothNeighbours neighbours(forest, leaf);
    if (neighbours.at_crease()) continue;  // a direction may lack neighbours
    const Vec3 normal = mesh.roots()[forest.id(leaf).root_face()].normal;
    const Vec3 expected = slope - dot(slope, normal) * normal;
    EXPECT_NEAR(length(leaf_slope(forest, leaf, neighbours, centre, value).g - 2 * expected), 0,
                1e-5);  // the ridge of the normal equations is 1e-6
    ++with_full_slope;
  }
  EXPECT_GT(with_full_slope, 10);
}

}  // namespace
}  // namespace alvor
