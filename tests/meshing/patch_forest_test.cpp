#include "meshing/patch_forest.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace alvor {
namespace {

void split_at_random(PatchForest& forest, const RefinementLimits& limits, int times) {
  std::mt19937 random(3);
  std::vector<NodeIndex> split;
  for (int n = 0; n < times; ++n) {
    const auto leaves = forest.leaves();
    forest.split(leaves[random() % leaves.size()], limits, split);
  }
}

Scene mixed_room() {
  Scene scene = test::furnace(1, 0.5);
  scene.faces[1].corner_count = 3;  // a triangle of the ceiling
  test::add_polygon(scene, {{0, 2, 0}, {3, 2, 4}, {0, 2, 4}});
  return scene;
}

TEST(PatchForest, LevelsAcrossEdgesDifferByAtMostOne) {
  const BaseMesh mesh(mixed_room());
  PatchForest forest(mesh);
  split_at_random(forest, {.max_level = 9}, 400);
  for (const NodeIndex leaf : forest.leaves()) {
    const PatchShape shape = forest.shape(leaf);
    for (int e = 0; e < shape.corner_count; ++e)
      for (const double t : {0.1, 0.4, 0.9}) {  // away from corners, which more than two leaves may share
        const NodeIndex other = forest.leaf_across(shape, e, t);
        if (other == PatchForest::no_node) continue;
        EXPECT_LE(std::abs(forest.id(other).level() - forest.id(leaf).level()), 1);
      }
  }
}

TEST(PatchForest, LeavesCoverEveryRootOnce) {
  const BaseMesh mesh(mixed_room());
  PatchForest forest(mesh);
  split_at_random(forest, {}, 200);
  std::vector<double> area(mesh.roots().size());
  for (const NodeIndex leaf : forest.leaves()) area[forest.id(leaf).root_face()] += area_of(mesh, forest.shape(leaf));
  for (std::size_t root = 0; root < area.size(); ++root) EXPECT_NEAR(area[root], mesh.roots()[root].area, 1e-9);
  EXPECT_EQ(forest.leaves().size(), forest.leaf_count());
}

TEST(PatchForest, LimitsAreKept) {
  const BaseMesh mesh(mixed_room());
  PatchForest deep(mesh), many(mesh), small(mesh);
  split_at_random(deep, {.max_level = 2}, 500);
  for (const NodeIndex leaf : deep.leaves()) EXPECT_LE(deep.id(leaf).level(), 2);
  split_at_random(many, {.max_leaves = 100}, 500);
  EXPECT_LE(many.leaf_count(), 100u);
  split_at_random(small, {.min_edge = 0.3}, 500);
  for (const NodeIndex leaf : small.leaves()) {
    const auto corners = corners_of(mesh, small.shape(leaf));
    EXPECT_GE(length(corners[1] - corners[0]), 0.3);
  }
}

TEST(PatchForest, LeafAtFindsTheLeafOfAPlace) {
  const BaseMesh mesh(mixed_room());
  PatchForest forest(mesh);
  split_at_random(forest, {}, 100);
  for (const NodeIndex leaf : forest.leaves()) {
    EXPECT_EQ(forest.leaf_at(forest.id(leaf).range_min()), leaf);
    EXPECT_EQ(forest.leaf_at(forest.id(leaf).range_max()), leaf);
  }
}

}  // namespace
}  // namespace alvor
