#include "radiosity/solve_state.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace alvor {
namespace {

/// What a refinement must keep: the leaves tile the roots, each place once.
void expect_tiling(const BaseMesh& mesh, std::vector<LeafValue> leaves) {
  std::ranges::sort(leaves, {}, &LeafValue::patch);
  for (std::size_t n = 1; n < leaves.size(); ++n)
    ASSERT_LT(leaves[n - 1].patch.range_max(), leaves[n].patch.range_min()) << "two leaves cover one place";
  double roots = 0, covered = 0;
  for (const RootPatch& root : mesh.roots()) roots += root.area;
  for (const LeafValue& leaf : leaves) covered += area_of(mesh, shape_of(mesh, leaf.patch));
  EXPECT_NEAR(covered, roots, 1e-9 * roots);
}

void pass_before_refining(SolveState& state) {
  state.trace_new_rows();
  state.add_new_direct_light([] {});
  state.begin_exchange();
  while (state.unshot_fraction() > 1e-3) state.exchange().sweep();
  state.estimate();
}

TEST(SolveState, RefiningTilesTheRootsWhereSolidsStandOnAFloor) {
  const BaseMesh mesh(test::room_with_contacts());
  for (const Strategy strategy : {Strategy::automatic, Strategy::sorted}) {
    RayBudget budget([] { return false; });
    SolveState state(mesh, {.max_leaves = 20'000, .strategy = strategy}, budget);
    for (int pass = 0; pass < 4; ++pass) {
      const std::size_t before = state.leaf_count();
      pass_before_refining(state);
      ASSERT_TRUE(state.refine());
      EXPECT_GT(state.leaf_count(), before);
      EXPECT_EQ(state.leaf_values().size(), state.leaf_count());
      expect_tiling(mesh, state.leaf_values());
    }
  }
}

TEST(SolveState, LimitsDoNotBreakTheTiling) {
  const BaseMesh mesh(test::room_with_contacts());
  for (const std::uint64_t most : {600u, 1100u, 1501u}) {
    RayBudget budget([] { return false; });
    SolveState state(mesh, {.max_leaves = most}, budget);
    for (int pass = 0; pass < 3; ++pass) {
      pass_before_refining(state);
      if (!state.refine()) break;
      EXPECT_LE(state.leaf_count(), most);
      EXPECT_EQ(state.leaf_values().size(), state.leaf_count());
      expect_tiling(mesh, state.leaf_values());
    }
  }
}

TEST(SolveState, PublishedLeavesTileTheRoots) {
  const BaseMesh mesh(test::room_with_contacts());
  SolutionLog log;
  solve(mesh, {.tolerance = 0.03, .max_leaves = 5000}, log, {});
  EXPECT_EQ(log.leaves().size(), log.last_step().leaves);
  expect_tiling(mesh, log.leaves());
}

}  // namespace
}  // namespace alvor
