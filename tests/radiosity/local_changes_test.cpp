// After an edit that changes little, only what it changes is looked at again.

#include "meshing/edit/edited_scene.h"
#include "radiosity/solve/pass.h"
#include "radiosity/solve/seen_space.h"
#include "tests/radiosity/edited_solve.h"
#include "tests/radiosity/solve_scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alvor {
namespace {

using test::EditedSolve;

Scene two_rooms_with_box_moved(Vec3 move) {
  return edited_scene(test::two_rooms(), std::vector<SceneEdit>{ObjectEdit{.name = "box", .move = move}});
}

/// Returns two_rooms() with the box moved, and two slabs 10 mm apart on the floor beside it, between which rows see slivers of
/// it.
Scene with_slabs(Vec3 move) {
  Scene scene = two_rooms_with_box_moved(move);
  test::add_box(scene, {0.6, 0, 2}, {1.595, 0.05, 3.6}, false);
  test::add_box(scene, {1.605, 0, 2}, {2.6, 0.05, 3.6}, false);
  return scene;
}

/// Exchanges the light of a pass until hardly any is left, and returns the estimate.
ErrorEstimate estimate_of(Pass& pass) {
  pass.prepare();
  settle(pass.exchange(), 1e-6, [](std::size_t) { return true; });
  return pass.estimate().value();
}

/// Fails unless an estimate that uses known errors tells the same as one that finds all: each leaf's to a twentieth, because
/// light may have changed by a twentieth of the tolerance where errors are kept, and of the sum much less, because these changes
/// are small where light has not changed.
void expect_to_tell_what_an_estimate_of_all_tells(SolveState& state) {
  ASSERT_FALSE(state.known_errors.empty());
  Pass some(state);
  const ErrorEstimate of_some = estimate_of(some);
  const std::vector<float> told = some.leaf_errors(of_some);
  state.known_errors.clear();
  Pass all(state);
  const ErrorEstimate of_all = estimate_of(all);
  const std::vector<float> told_of_all = all.leaf_errors(of_all);
  EXPECT_NEAR(of_some.total(), of_all.total(), 0.01 * of_all.total());
  ASSERT_EQ(told.size(), told_of_all.size());
  double squares = 0, all_squares = 0;
  for (std::size_t n = 0; n < told.size(); ++n) {
    squares += std::pow(told[n] - told_of_all[n], 2);
    all_squares += std::pow(told_of_all[n], 2);
  }
  EXPECT_LT(std::sqrt(squares / all_squares), 0.05);
}

/// Moves the box of a live solve, and mends what that changes.
void take_move(LiveSolve& live, Vec3 move) {
  const BaseMesh mesh = BaseMesh(test::two_rooms()).edited_as(two_rooms_with_box_moved(move));
  ASSERT_TRUE(live.take_edit(mesh, Plan(mesh, live.state.options)));
  live.state.mend_moved();
}

TEST(KnownErrors, AreNotFoundAgainInTheOtherRoom) {
  EditedSolve solve(test::two_rooms(), {.tolerance = 0.05});
  SolveState& state = solve.live()->state;
  for (const NodeIndex leaf : state.forests.leaves().leaves()) {
    if (centre_of(state.mesh, state.forests.leaves().shape(leaf)).x < 10) continue;
    const auto known = state.known_errors.of_leaf(leaf);
    state.known_errors.set_leaf(leaf, {1e4 * std::abs(known.error.square), known.error.split}, known.irradiance);
  }
  take_move(*solve.live(), {1, 0.2, 1});
  Pass pass(state);
  EXPECT_GT(estimate_of(pass).interpolation, 3 * 0.05);
}

TEST(KnownErrors, OfAMoveThatIsBrokenOffAreFoundAfterTheNext) {
  for (const int steps : {0, 1, 2}) {
    SCOPED_TRACE(steps);
    EditedSolve solve(test::two_rooms(), {.tolerance = 0.05});
    LiveSolve& live = *solve.live();
    take_move(live, {1, 0.2, 1});
    if (Pass broken_off(live.state); steps > 0) {
      broken_off.trace_rows();
      if (steps > 1) broken_off.add_direct_light(), broken_off.begin_exchange().sweep();
    }
    take_move(live, {0.3, 0, 1.5});
    expect_to_tell_what_an_estimate_of_all_tells(live.state);
  }
}

TEST(KnownErrors, TellWhatAnEstimateOfAllTells) {
  std::size_t refined = 0;
  for (const double tolerance : {0.05, 0.03, 0.02}) {
    SCOPED_TRACE(tolerance);
    EditedSolve solve(test::two_rooms(), {.tolerance = tolerance});
    const std::uint64_t leaves = solve.last().leaves;
    solve.edit([](Scene& scene) { scene = two_rooms_with_box_moved({1, 0.2, 1}); });
    refined += solve.last().leaves > leaves;
    expect_to_tell_what_an_estimate_of_all_tells(solve.live()->state);
  }
  EXPECT_GT(refined, 0u) << "no pass refines after the edit";
}

TEST(KnownErrors, OfSliversTellWhatAnEstimateOfAllTells) {
  EditedSolve solve(with_slabs({0, 0, 0}), {.tolerance = 0.03});
  SolveState& state = solve.live()->state;
  EXPECT_FALSE(state.slivers.find(state.forests, state.rows).empty()) << "no row sees a sliver";
  for (const Vec3 move : {Vec3{1, 0.2, 1}, Vec3{0.3, -0.4, 1.2}, Vec3{0.3, -0.4, 1.25}}) {
    solve.edit([&](Scene& scene) { scene = with_slabs(move); });
    expect_to_tell_what_an_estimate_of_all_tells(solve.live()->state);
  }
}

TEST(KnownErrors, AreForgottenWhereLightsOrReflectancesChange) {
  const auto is_known_after = [](const Scene& edited) {
    EditedSolve solve(test::two_rooms(), {.tolerance = 0.05});
    LiveSolve& live = *solve.live();
    const BaseMesh mesh = BaseMesh(test::two_rooms()).edited_as(edited);
    EXPECT_TRUE(live.take_edit(mesh, Plan(mesh, live.state.options)));
    return !live.state.known_errors.empty();
  };
  const Scene moved = two_rooms_with_box_moved({1, 0.2, 1});
  Scene dimmed = test::two_rooms(), recoloured = test::two_rooms();
  dimmed.materials[1].emission = {1, 1, 0.5};
  recoloured.materials[0].reflectance = {0.5, 0.5, 0.4};
  EXPECT_TRUE(is_known_after(moved));
  EXPECT_FALSE(is_known_after(dimmed));
  EXPECT_FALSE(is_known_after(recoloured));
  dimmed = moved;
  dimmed.materials[1].emission = {1, 1, 0.5};
  EXPECT_FALSE(is_known_after(dimmed));
}

TEST(SeenSpace, ReachesAllOfARoomAndNothingOfAnother) {
  const Scene scene = test::two_rooms();
  const BaseMesh mesh(scene);
  const LocalScene local(mesh);
  RayBudget budget([] { return false; });
  const BoundingBox box{{1, 0.5, 1}, {1.5, 1, 1.5}};
  const SeenSpace space(local, std::span(&box, 1), 1, budget);
  EXPECT_EQ(budget.rays(), SeenSpace::rays_from(1));
  constexpr double size = 0.1;
  for (double x = 0; x + size <= 4; x += size)
    for (double y = 0; y + size <= 3; y += size)
      for (double z = 0; z + size <= 4; z += size) {
        const Vec3 low{x, y, z}, of_cell{size, size, size};
        EXPECT_TRUE(space.reaches({low, low + of_cell}));
        const Vec3 there = low + Vec3{10, 0, 0};
        EXPECT_FALSE(space.reaches({there, there + of_cell}));
      }
}

TEST(EditedSolve, ShowsReflectedLightDimmedBeforeItHasGoneRound) {
  const Scene submitted = test::room_with_lamps_and_sun();
  EditedSolve solve(submitted, {.tolerance = 0.05});
  LiveSolve& live = *solve.live();
  const auto mean = [&] {
    double sum = 0, area = 0;
    for (const LeafValue& leaf : live.state.leaf_values()) {
      const double own = area_of(live.state.mesh, shape_of(live.state.mesh, leaf.patch));
      sum += own * leaf.irradiance.mean(), area += own;
    }
    return sum / area;
  };
  const double before = mean();
  Scene dimmed = submitted;
  dimmed.lights[2].intensity = 0.5 * dimmed.lights[2].intensity;
  const BaseMesh mesh = BaseMesh(submitted).edited_as(dimmed);
  ASSERT_TRUE(live.take_edit(mesh, Plan(mesh, live.state.options)));
  Pass pass(live.state);
  pass.trace_rows();
  pass.add_direct_light();
  const double at_first = mean();
  settle(pass.begin_exchange(), 1e-6, [](std::size_t) { return true; });
  pass.show_smoothly();
  const double at_last = mean();
  EXPECT_LT(at_last, 0.9 * before) << "the edit changes little";
  EXPECT_NEAR(at_first, at_last, 0.03 * at_last);
}

}  // namespace
}  // namespace alvor
