#include "meshing/patch_forest.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace alvor {
namespace {

enum class Kinds { quarters, all };

void split_at_random(PatchForest& forest, const RefinementLimits& limits, int times, Kinds kinds = Kinds::quarters) {
  std::mt19937 random(3);
  std::vector<NodeIndex> split;
  for (int n = 0; n < times; ++n) {
    const auto leaves = forest.leaves();
    const auto leaf = leaves[random() % leaves.size()];
    forest.split(leaf, limits, split, kinds == Kinds::all ? static_cast<Split>(random() % 3) : Split::quarters);
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

TEST(PatchForest, NoEdgeIsMoreThanFourTimesAsLongAsTheLongestOfTheLeafAcross) {
  const BaseMesh mesh(mixed_room());
  PatchForest forest(mesh);
  split_at_random(forest, {}, 2000, Kinds::all);
  std::size_t slabs = 0, too_long = 0, edges = 0;
  for (const NodeIndex leaf : forest.leaves()) {
    const PatchShape shape = forest.shape(leaf);
    slabs += forest.id(leaf).has_slabs();
    for (int e = 0; e < shape.corner_count; ++e) {
      const NodeIndex other = forest.leaf_across(shape, e, 0.4);
      if (other == PatchForest::no_node) continue;
      const PatchShape there = forest.shape(other);
      ++edges;
      too_long += shape.size_along(e) > 4 * std::max(std::abs(there.size_u), std::abs(there.size_v));
    }
  }
  EXPECT_GT(slabs, 1000u);
  EXPECT_GT(edges, 1000u);
  EXPECT_EQ(too_long, 0u);
}

TEST(PatchForest, LeavesCoverEveryRootOnce) {
  const BaseMesh mesh(mixed_room());
  PatchForest forest(mesh);
  split_at_random(forest, {}, 400, Kinds::all);
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

TEST(PatchForest, ASlabThatIsTooThinForQuartersDoesNotKeepItsNeighboursFromSplits) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const BaseMesh mesh(scene);
  PatchForest forest(mesh);
  const RefinementLimits limits{.min_edge = 0.04};
  std::vector<NodeIndex> split;
  ASSERT_TRUE(forest.split(0, limits, split));
  // The upper left quarter becomes slabs of 0.5 by 0.125 m, and the lowest of them such of 0.5 by 0.03 m: too thin.
  const NodeIndex upper_left = forest.child(0, 2);
  ASSERT_TRUE(forest.split(upper_left, {}, split, Split::slabs_along_v));
  ASSERT_TRUE(forest.split(forest.child(upper_left, 0), {}, split, Split::slabs_along_v));
  const NodeIndex lower_left = forest.child(0, 0);
  ASSERT_TRUE(forest.split(lower_left, limits, split));
  EXPECT_TRUE(forest.split(forest.child(lower_left, 2), limits, split)) << "0.25 m wide, below slabs 0.5 m long";
}

TEST(PatchForest, TheSidesOfATranslucentFaceAreSplitAlikeAlsoIntoSlabs) {
  Scene scene;
  scene.materials = {{.name = "lampshade", .two_sided = true, .diffuse_transmittance = {0.3, 0.3, 0.3}}};
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  const BaseMesh mesh(scene);
  PatchForest forest(mesh);
  split_at_random(forest, {}, 200, Kinds::all);
  for (const NodeIndex leaf : forest.leaves()) {
    const NodeIndex behind = forest.leaf_behind(leaf);
    EXPECT_EQ(forest.id(behind), twin_of(mesh, forest.id(leaf)));
    EXPECT_NEAR(length(centre_of(mesh, forest.shape(leaf)) - centre_of(mesh, forest.shape(behind))), 0, 1e-12);
  }
}

TEST(PatchForest, LeafAtFindsTheLeafOfAPointAmongSlabs) {
  const BaseMesh mesh(mixed_room());
  PatchForest forest(mesh);
  split_at_random(forest, {}, 400, Kinds::all);
  for (const NodeIndex leaf : forest.leaves()) {
    const PatchId id = forest.id(leaf);
    EXPECT_EQ(forest.leaf_at(id), leaf);
    const PatchShape shape = forest.shape(leaf);
    for (int o = 0; o < strata_per_patch && std::min(std::abs(shape.size_u), std::abs(shape.size_v)) >= 8; ++o) {
      const PatchId place = finest_patch(mesh, id.root_face(), shape.stratum_centre(o));
      EXPECT_EQ(forest.leaf_at(place), leaf);
      for (PatchId above = id; !above.is_root(); above = above.parent())
        EXPECT_EQ(forest.leaf_at(place, forest.node_in_place_of(above)), leaf);
    }
  }
}

TEST(PatchForest, TheCoarserOfTwoForestsIsSplitAsTheFinerIs) {
  const BaseMesh mesh(mixed_room());
  PatchForest fine(mesh), coarse(mesh);
  split_at_random(fine, {}, 300, Kinds::all);
  std::mt19937 random(4);
  std::vector<NodeIndex> split;
  for (int n = 0; n < 300; ++n) {
    const auto leaves = coarse.leaves();
    coarse.split_as(fine, leaves[random() % leaves.size()], {}, split);
  }
  EXPECT_GT(coarse.leaf_count(), 200u);
  for (const NodeIndex leaf : coarse.leaves()) EXPECT_EQ(fine.id(fine.node_in_place_of(coarse.id(leaf))), coarse.id(leaf));
}

TEST(PatchForest, SplitsDownToTheLeavesOfAnother) {
  const BaseMesh mesh(mixed_room());
  PatchForest forest(mesh), same(mesh);
  split_at_random(forest, {}, 300, Kinds::all);
  std::vector<LeafValue> leaves;
  for (const NodeIndex leaf : forest.leaves()) leaves.push_back({forest.id(leaf), {}});
  same.split_down_to(leaves);
  ASSERT_EQ(same.leaf_count(), leaves.size());
  const auto nodes = same.leaves();
  for (std::size_t n = 0; n < nodes.size(); ++n) EXPECT_EQ(same.id(nodes[n]), leaves[n].patch);
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
