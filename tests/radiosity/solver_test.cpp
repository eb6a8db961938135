#include "radiosity/solve/solver.h"

#include "meshing/patch_place.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace alvor {
namespace {

std::vector<LeafValue> solved(const Scene& scene, const SolveOptions& options = {}) {
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, options, log, {});
  EXPECT_TRUE(log.closed());
  return log.leaves();
}

/// Returns a room with a lamp in the ceiling and a block on the floor.
Scene lit_room(double scale = 1) {
  Scene scene;
  scene.materials = {test::grey(0, 0.6), test::grey(50, 0)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true);
  test::add_box(scene, {1, 0, 1}, {2, 1, 3}, false);
  test::add_polygon(scene, {{1.5, 2.99, 2}, {2.5, 2.99, 2}, {2.5, 2.99, 3}, {1.5, 2.99, 3}}, 1);
  for (Vec3& vertex : scene.vertices) vertex = scale * vertex;
  return scene;
}

double shortest_edge_of(const BaseMesh& mesh, PatchId patch) {
  const PatchShape shape = shape_of(mesh, patch);
  const auto corners = corners_of(mesh, shape);
  double shortest = 1e9;
  for (int e = 0; e < shape.corner_count; ++e)
    shortest = std::min(shortest, length(corners[(e + 1) % shape.corner_count] - corners[e]));
  return shortest;
}

TEST(Solver, FurnaceIsExactOnAnyMesh) {
  // B = E / (1 - rho) everywhere, so H = 2 for E = 1 and rho = 0.5.
  for (const int depth : {0, 1, 3}) {
    for (const bool with_block : {false, true}) {
      Scene scene = test::furnace(1, 0.5);
      if (with_block) test::add_box(scene, {1, 0.5, 1}, {2, 1, 2}, false);
      for (const LeafValue& leaf : solved(scene, {.tolerance = 1e-9, .max_depth = depth, .max_leaves = 2000}))
        EXPECT_NEAR(leaf.irradiance.g, 2, 2e-5) << "depth " << depth;
    }
  }
}

TEST(Solver, FurnaceIsExactByHemicubesToo) {
  for (const LeafValue& leaf :
       solved(test::furnace(1, 0.5), {.tolerance = 1e-9, .max_depth = 2, .form_factors = FormFactorMethod::hemicube}))
    EXPECT_NEAR(leaf.irradiance.g, 2, 2e-5);
}

TEST(Solver, ExactFormFactorsAgreeWithRays) {
  const SolveOptions by_rays{.tolerance = 1e-9, .max_depth = 1},
      exact{.tolerance = 1e-9, .max_depth = 1, .form_factors = FormFactorMethod::analytic};
  const auto sampled = solved(lit_room(), by_rays), analytic = solved(lit_room(), exact);
  ASSERT_EQ(sampled.size(), analytic.size());
  double squares = 0, mean = 0;
  for (std::size_t n = 0; n < sampled.size(); ++n) {
    ASSERT_EQ(sampled[n].patch, analytic[n].patch);
    squares += std::pow(sampled[n].irradiance.g - analytic[n].irradiance.g, 2) / static_cast<double>(sampled.size());
    mean += analytic[n].irradiance.g / static_cast<double>(sampled.size());
  }
  // Rows of at most 4096 rays are accurate to one percent. Slopes and contacts, which differ by method, are accurate to a few
  // percent.
  EXPECT_LT(std::sqrt(squares), 0.03 * mean);
}

TEST(Solver, FurnaceIsExactByExactFormFactorsToo) {
  for (const LeafValue& leaf :
       solved(test::furnace(1, 0.5), {.tolerance = 1e-9, .max_depth = 2, .form_factors = FormFactorMethod::analytic}))
    EXPECT_NEAR(leaf.irradiance.g, 2, 2e-4);  // exact rows aim at an accuracy of 1e-4 per form factor
}

TEST(Solver, LuminousCeilingOfAConvexRoomSatisfiesTheMeanValueIdentity) {
  // With uniform rho the mean of B over the area is mean E / (1 - rho), whatever the emission (reciprocity and closure).
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(1, 0.5)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, true, {0, 1, 0, 0, 0, 0});
  const BaseMesh mesh(scene);
  double mean = 0;
  for (const LeafValue& leaf : solved(scene, {.tolerance = 0.005})) {
    const double emission = mesh.material_of(leaf.patch.root_face()).emission.g;
    mean += area_of(mesh, shape_of(mesh, leaf.patch)) * (emission + 0.5 * leaf.irradiance.g) / 6;
  }
  EXPECT_NEAR(mean, (1.0 / 6) / (1 - 0.5), 0.005 / 3);
}

TEST(Solver, PowersOfTwoOfTheUnitOfLengthChangeNoBit) {
  const auto metres = solved(lit_room());
  for (const double scale : {0.5, 1024.0}) EXPECT_EQ(metres, solved(lit_room(scale))) << scale;
}

TEST(Solver, UnitsAndOriginDoNotMatter) {
  Scene moved = lit_room();
  for (Vec3& vertex : moved.vertices) vertex += {1e5, -2e5, 3e5};
  const auto metres = solved(lit_room());
  for (const auto& other : {solved(lit_room(1000)), solved(lit_room(0.001)), solved(moved)}) {
    ASSERT_EQ(metres.size(), other.size());
    for (std::size_t n = 0; n < metres.size(); ++n) {
      EXPECT_EQ(metres[n].patch, other[n].patch);
      // Coordinates round differently; none is so near to a ray that it matters.
      EXPECT_NEAR(metres[n].irradiance.g, other[n].irradiance.g, 1e-6 * metres[n].irradiance.g);
    }
  }
}

TEST(Solver, SameSeedGivesTheSameBytesOnAnyNumberOfThreads) {
  const auto once = solved(lit_room(), {.threads = 1, .seed = 4});
  EXPECT_EQ(once, solved(lit_room(), {.threads = 1, .seed = 4}));
  EXPECT_EQ(once, solved(lit_room(), {.threads = 2, .seed = 4}));
  EXPECT_NE(once, solved(lit_room(), {.threads = 1, .seed = 5}));
}

TEST(Solver, LimitsAreKeptAndNamed) {
  const BaseMesh mesh(lit_room());
  constexpr double never = 1e-9, shortest_edge = 0.3;
  SolutionLog few, shallow, coarse, brief;
  EXPECT_EQ(solve(mesh, {.tolerance = never, .max_leaves = 1500}, few, {}).reason, StopReason::max_leaves);
  EXPECT_LE(few.leaves().size(), 1500u);
  EXPECT_EQ(solve(mesh, {.tolerance = never, .max_depth = 2}, shallow, {}).reason, StopReason::max_depth);
  for (const LeafValue& leaf : shallow.leaves()) EXPECT_LE(leaf.patch.level(), 2);
  EXPECT_EQ(solve(mesh, {.tolerance = never, .min_edge_m = shortest_edge}, coarse, {}).reason, StopReason::max_depth);
  for (const LeafValue& leaf : coarse.leaves()) {
    EXPECT_TRUE(leaf.patch.level() == 0 || shortest_edge_of(mesh, leaf.patch) >= shortest_edge * (1 - 1e-12));
  }
  EXPECT_EQ(solve(mesh, {.tolerance = never, .time_limit_s = 1e-9}, brief, {}).reason, StopReason::time_limit);
}

TEST(Solver, ALimitToTheDepthMakesASolveCheaper) {
  const BaseMesh mesh(lit_room());
  for (const Strategy strategy : {Strategy::automatic, Strategy::sorted}) {
    SolutionLog deep;
    EXPECT_EQ(solve(mesh, {.tolerance = 0.01, .strategy = strategy}, deep, {}).reason, StopReason::tolerance);
    for (const int depth : {2, 3, 4}) {
      SolutionLog shallow;
      EXPECT_EQ(solve(mesh, {.tolerance = 0.01, .max_depth = depth, .strategy = strategy}, shallow, {}).reason,
                StopReason::max_depth);
      EXPECT_LT(shallow.last_step().rays, deep.last_step().rays) << depth;
      EXPECT_LT(shallow.last_step().leaves, deep.last_step().leaves) << depth;
    }
  }
}

TEST(Solver, ALimitToTheDepthCostsNeitherRaysNorMuchErrorWhereverTheToleranceLies) {
  const BaseMesh mesh(lit_room());
  for (const int depth : {3, 4, 5}) {
    SolutionLog best;
    solve(mesh, {.tolerance = 0.002, .max_depth = depth}, best, {});
    const double reachable = best.last_step().estimated_error;
    for (const double share : {0.7, 0.9, 1.0, 1.1, 1.4}) {
      const double tolerance = share * reachable;
      SolutionLog shallow, deep;
      const StopReason reason = solve(mesh, {.tolerance = tolerance, .max_depth = depth}, shallow, {}).reason;
      solve(mesh, {.tolerance = tolerance}, deep, {});
      EXPECT_LE(shallow.last_step().rays, deep.last_step().rays) << depth << ' ' << share;
      EXPECT_LE(shallow.last_step().estimated_error, 1.4 * std::max(tolerance, reachable)) << depth << ' ' << share;
      EXPECT_TRUE(share < 1.4 || reason == StopReason::tolerance) << depth << ": it is within reach";
    }
  }
}

TEST(Solver, EndsWhenEnoughOfTheAreaIsWithinTheTolerance) {
  const BaseMesh mesh(lit_room());
  constexpr double tolerance = 0.05;
  SolutionLog most, nearly_all;
  EXPECT_EQ(solve(mesh, {.tolerance = tolerance, .area_share = 0.8}, most, {}).reason, StopReason::tolerance);
  EXPECT_GE(most.last_step().area_within, 0.8);
  EXPECT_EQ(solve(mesh, {.tolerance = tolerance, .area_share = 0.97}, nearly_all, {}).reason, StopReason::tolerance);
  EXPECT_GE(nearly_all.last_step().area_within, 0.97);
  EXPECT_GT(nearly_all.last_step().leaves, most.last_step().leaves);
}

TEST(Solver, KeepsTheToleranceOnNamedObjectsAndRefinesNothingElse) {
  Scene scene = lit_room();
  // The room; the block, which hangs from a table that has no faces; the lamp.
  scene.objects = {{"room", {}, {}, 0, 6}, {"table", {}, {}, 6, 0}, {"block", 1, {}, 6, 6}, {"lamp", {}, {}, 12, 1}};
  const BaseMesh mesh(scene);
  ASSERT_FALSE(find_fault(scene));
  constexpr double tolerance = 0.01;
  SolutionLog all, part, unknown;
  EXPECT_EQ(solve(mesh, {.tolerance = tolerance, .area_share = 0.95}, all, {}).reason, StopReason::tolerance);
  EXPECT_EQ(solve(mesh, {.tolerance = tolerance, .area_share = 0.95, .objects = {"table"}}, part, {}).reason,
            StopReason::tolerance);
  EXPECT_GE(part.last_step().area_within, 0.95);
  EXPECT_LT(part.last_step().rays, 0.5 * static_cast<double>(all.last_step().rays));
  const auto leaves_of_block = [&](const SolutionLog& log) {
    return std::ranges::count_if(log.leaves(), [&](const LeafValue& leaf) {
      const std::uint32_t face = mesh.roots()[leaf.patch.root_face()].input.first;
      return face >= 6 && face < 12;
    });
  };
  EXPECT_GT(leaves_of_block(part), leaves_of_block(all) / 2);
  EXPECT_EQ(solve(mesh, {.tolerance = tolerance, .objects = {"nobody"}}, unknown, {}).reason, StopReason::tolerance)
      << "nothing has to be within the tolerance";
}

TEST(Solver, RoomWithoutLightIsBlackAndDone) {
  Scene scene;
  scene.materials = {test::grey(0, 0.6)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true);
  const BaseMesh mesh(scene);
  SolutionLog log;
  EXPECT_EQ(solve(mesh, {}, log, {}).reason, StopReason::dark);
  EXPECT_EQ(log.last_step().rays, 0u);
  EXPECT_EQ(log.last_step().unshot_fraction, 0);
  EXPECT_EQ(log.last_step().estimated_error, 0);
  for (const LeafValue& leaf : log.leaves()) EXPECT_TRUE(leaf.irradiance.is_zero());
}

TEST(Solver, StrategyThatCannotBringTheLightRoundSaysSo) {
  Scene scene;
  scene.materials = {test::grey(0, 0.999999), test::grey(1, 0.999999)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, true, {0, 1, 0, 0, 0, 0});
  const BaseMesh mesh(scene);
  for (const Strategy strategy : {Strategy::gather, Strategy::shoot, Strategy::sorted}) {
    SolutionLog log;
    EXPECT_EQ(solve(mesh, {.strategy = strategy}, log, {}).reason, StopReason::stalled) << text(strategy);
    EXPECT_GT(log.last_step().estimated_error, 0.9) << text(strategy);
  }
  SolutionLog log;
  EXPECT_EQ(solve(mesh, {}, log, {}).reason, StopReason::tolerance);
}

TEST(Solver, ShortOfMemoryItEndsWithTheLastStepThatItPublished) {
  const BaseMesh mesh(lit_room());
  SolutionLog log;
  std::stop_source memory;
  const auto handle = log.listen([&] {
    if (log.head() == 6) memory.request_stop();
  });
  SolveControl control;
  control.short_of_memory = memory.get_token();
  const SolveOptions options;
  EXPECT_EQ(solve_as_planned(mesh, Plan(mesh, options), options, log, control).reason, StopReason::memory);
  log.forget(handle);
  EXPECT_EQ(log.head(), 6u);
}

TEST(Solver, StopRequestLeavesAUsableSolution) {
  const BaseMesh mesh(lit_room());
  SolutionLog log;
  std::stop_source stop;
  const auto handle = log.listen([&] {
    if (log.head() == 6) stop.request_stop();
  });
  EXPECT_EQ(solve(mesh, {}, log, stop.get_token()).reason, StopReason::cancelled);
  log.forget(handle);
  EXPECT_EQ(log.head(), 6u);
  EXPECT_TRUE(log.closed());
  double brightest = 0;
  for (const LeafValue& leaf : log.leaves()) brightest = std::max<double>(brightest, leaf.irradiance.g);
  EXPECT_GT(brightest, 1);
}

TEST(Solver, StepsCountUpAndUnshotPowerGoesDownInEachPass) {
  const BaseMesh mesh(lit_room());
  for (const Strategy strategy :
       {Strategy::automatic, Strategy::gather, Strategy::shoot, Strategy::sorted, Strategy::overshoot}) {
    SCOPED_TRACE(text(strategy));
    SolutionLog log;
    solve(mesh, {.strategy = strategy}, log, {});
    const auto steps = log.steps();
    ASSERT_GT(steps.size(), 8u);
    EXPECT_EQ(steps.front().rays, 0u);
    EXPECT_EQ(steps.front().unshot_fraction, 1);
    for (std::size_t n = 1; n < steps.size(); ++n) {
      EXPECT_EQ(steps[n].revision, steps[n - 1].revision + 1);
      EXPECT_GE(steps[n].elapsed_s, steps[n - 1].elapsed_s);
      EXPECT_GE(steps[n].rays, steps[n - 1].rays);
      EXPECT_GE(steps[n].leaves, steps[n - 1].leaves);
      const bool is_same_pass = steps[n].rays == steps[n - 1].rays && steps[n].leaves == steps[n - 1].leaves;
      EXPECT_TRUE(!is_same_pass || steps[n].unshot_fraction <= steps[n - 1].unshot_fraction) << n;
    }
    EXPECT_LE(steps.back().unshot_fraction, 1e-6);
    EXPECT_LE(steps.back().estimated_error, 0.02);
  }
}

TEST(Solver, AmbientTermFadesAsLightIsShot) {
  const BaseMesh mesh(lit_room());
  SolutionLog with, without;
  solve(mesh, {.strategy = Strategy::sorted_ambient}, with, {});
  solve(mesh, {.strategy = Strategy::sorted}, without, {});
  double largest = 0;
  for (const Step& step : with.steps()) largest = std::max(largest, step.ambient_irradiance.g);
  EXPECT_GT(largest, 0.1);
  EXPECT_LT(with.last_step().ambient_irradiance.g, 1e-4 * largest);
  for (const Step& step : without.steps()) EXPECT_TRUE(step.ambient_irradiance.is_zero());
  EXPECT_EQ(with.leaves(), without.leaves());
}

}  // namespace
}  // namespace alvor
