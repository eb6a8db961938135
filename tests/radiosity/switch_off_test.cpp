// Forces on each feature that the plan switches off: the answer stays the same and takes more work.

#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace alvor {
namespace {

struct Solved {
  std::vector<LeafValue> leaves;  ///< leaves that receive light, in the order of their ids
  std::uint64_t rays = 0, all_leaves = 0;
};

Solved solved(const Scene& scene, const SolveOptions& options) {
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, options, log, {});
  Solved all{log.leaves(), log.last_step().rays, log.last_step().leaves};
  std::erase_if(all.leaves, [](const LeafValue& leaf) { return leaf.irradiance.is_zero(); });
  std::ranges::sort(all.leaves, {}, &LeafValue::patch);
  return all;
}

struct Pair {
  Solved as_planned, forced;
  /// Returns the largest difference of irradiance as a share of the largest irradiance; 1 if the meshes differ.
  double difference() const {
    if (!std::ranges::equal(as_planned.leaves, forced.leaves, {}, &LeafValue::patch, &LeafValue::patch)) return 1;
    double largest = 0, difference = 0;
    for (std::size_t n = 0; n < forced.leaves.size(); ++n) {
      const RgbF &a = as_planned.leaves[n].irradiance, &b = forced.leaves[n].irradiance;
      largest = std::max<double>(largest, b.max());
      difference = std::max<double>(difference, absolute(a - b).max());
    }
    return difference / largest;
  }
};

/// Solves as planned and with the feature forced on. Fails unless the plan switches the feature off.
Pair solved_both_ways(const Scene& scene, Feature feature, SolveOptions options = {}) {
  options.threads = 1;
  EXPECT_FALSE(Plan(BaseMesh(scene), options).needs(feature)) << text(feature);
  Pair pair;
  pair.as_planned = solved(scene, options);
  options.forced_on.add(feature);
  pair.forced = solved(scene, options);
  return pair;
}

/// Returns an empty room whose ceiling is a lamp.
Scene convex_room() {
  Scene scene;
  scene.materials = {test::grey(0, 0.6), test::grey(10, 0.2)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true, {0, 1, 0, 0, 0, 0});
  return scene;
}

// Rows whose rays no guide turns: guides follow the light that an unfinished exchange has found, and how far it has gone depends
// on which faces take part.
const SolveOptions not_guided{.form_factors = FormFactorMethod::hemicube};

constexpr double rounding = 1e-5;  // share of the largest irradiance; some ten reflections round to float32 (6e-8) each

TEST(SwitchedOff, OcclusionInAConvexRoomSavesAllShadowRays) {
  const Pair pair = solved_both_ways(convex_room(), Feature::occlusion, {.tolerance = 0.03});
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

TEST(SwitchedOff, OcclusionInAConvexRoomFullOfFogSavesAllShadowRays) {
  Scene scene = convex_room();
  scene.absorption = {0.1, 0.2, 0.3};
  const Pair pair = solved_both_ways(scene, Feature::occlusion, {.max_leaves = 2000});
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

TEST(SwitchedOff, OcclusionUnderManyLampsSavesAllShadowRays) {
  Scene scene;
  scene.materials = {test::grey(0, 0.6), test::grey(10, 0)};
  test::add_box(scene, {0, 0, 0}, {8, 3, 8}, true);
  scene.faces.erase(scene.faces.begin() + 1);  // the ceiling is replaced by tiles, every other one of which is a lamp
  for (int x = 0; x < 6; ++x)
    for (int z = 0; z < 6; ++z) {
      const double a = x * 8 / 6.0, c = z * 8 / 6.0, b = (x + 1) * 8 / 6.0, d = (z + 1) * 8 / 6.0;
      test::add_polygon(scene, {{a, 3, c}, {b, 3, c}, {b, 3, d}, {a, 3, d}}, static_cast<std::uint32_t>((x + z) % 2));
    }
  const Pair pair = solved_both_ways(scene, Feature::occlusion, {.tolerance = 0.1, .max_leaves = 2000});
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

TEST(SwitchedOff, DarkFacesBehindClosedWallsSaveTheirRows) {
  Scene scene = convex_room();
  test::add_box(scene, {4.5, 0, 0}, {9.5, 3, 5}, true);
  for (const SolveOptions& options : {not_guided, SolveOptions{.tolerance = 0.05}}) {
    const Pair pair = solved_both_ways(scene, Feature::dark_faces, options);
    EXPECT_LT(pair.difference(), rounding);
    EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
    EXPECT_LT(pair.as_planned.all_leaves, pair.forced.all_leaves);
  }
}

TEST(SwitchedOff, DarkOuterWallsSaveTheirRows) {
  Scene scene = convex_room();
  test::add_box(scene, {-0.1, -0.1, -0.1}, {4.1, 3.1, 5.1}, false);
  const Pair pair = solved_both_ways(scene, Feature::dark_faces);
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

Scene black_room() { return test::black(test::room_with_contacts()); }

TEST(SwitchedOff, RowsOfABlackRoomSaveTheirRays) {
  const Pair pair = solved_both_ways(black_room(), Feature::indirect_rows, {.tolerance = 0.05});
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_LT(pair.as_planned.rays, pair.forced.rays);
}

TEST(SwitchedOff, RowsOfABlackConvexRoomSaveTheirRays) {
  const Pair pair = solved_both_ways(test::black(convex_room()), Feature::indirect_rows);
  EXPECT_LT(pair.difference(), rounding);
  EXPECT_EQ(pair.as_planned.rays, 0u);
}

TEST(SwitchedOff, RowsOfABlackRoomAreNotMissedByAnyStrategy) {
  for (const Strategy strategy : {Strategy::gather, Strategy::shoot, Strategy::sorted, Strategy::overshoot})
    EXPECT_EQ(solved(black_room(), {.tolerance = 0.1, .strategy = strategy}).leaves,
              solved(black_room(), {.tolerance = 0.1}).leaves);
}

TEST(SwitchedOff, TwoBandsOfThreeAreNotMissedInAGreyRoom) {
  for (const double absorption : {0.0, 0.05}) {
    Scene scene = test::coloured_room();
    scene.materials[2] = test::grey(0, 0.4);
    scene.absorption = {absorption, absorption, absorption};
    const Pair pair = solved_both_ways(scene, Feature::three_bands, {.tolerance = 0.05, .max_leaves = 3000});
    EXPECT_LT(pair.difference(), rounding);
    for (const LeafValue& leaf : pair.as_planned.leaves) EXPECT_TRUE(leaf.irradiance.is_grey());
  }
}

TEST(SwitchedOff, AccelerationIsNotMissedWhereLittleIsReflected) {
  Scene scene = test::coloured_room();
  for (Material& material : scene.materials) material.reflectance *= 0.2;
  const Pair pair = solved_both_ways(scene, Feature::acceleration, {.tolerance = 0.02});
  EXPECT_LT(pair.difference(), rounding);
}

TEST(SwitchedOff, BackSidesOfOneSidedFacesAreNotMissed) {
  const Pair pair = solved_both_ways(test::coloured_room(), Feature::back_sides, {.tolerance = 0.05});
  EXPECT_EQ(pair.as_planned.leaves, pair.forced.leaves);
}

TEST(SwitchedOff, ClearAirIsNotMissed) {
  const Pair pair = solved_both_ways(test::coloured_room(), Feature::medium, {.tolerance = 0.05});
  EXPECT_LT(pair.difference(), rounding);
}

TEST(SwitchedOff, PlacesOfHitsAreNotMissedAtDepthZero) {
  for (const Strategy strategy : {Strategy::automatic, Strategy::sorted}) {
    const Pair pair =
        solved_both_ways(test::coloured_room(), Feature::refinement, {.tolerance = 1e-3, .max_depth = 0, .strategy = strategy});
    EXPECT_EQ(pair.as_planned.leaves, pair.forced.leaves);
    EXPECT_EQ(pair.as_planned.all_leaves, 13u);
  }
}

TEST(SwitchedOff, NoLightMeansNoWork) {
  Scene scene = convex_room();
  scene.materials[1].emission = {};
  const Solved dark = solved(scene, {});
  EXPECT_TRUE(dark.leaves.empty());
  EXPECT_EQ(dark.rays, 0u);
  EXPECT_EQ(dark.all_leaves, 6u);
}

/// Returns a lit room with boxes of random size and place in and around it, closed and open, through walls or on the floor.
Scene boxes_about_a_room(unsigned seed) {
  std::mt19937 random(seed);
  const auto whole = [&](int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); };
  Scene scene = convex_room();
  for (int box = 0; box < 5; ++box) {
    const double x = whole(-4, 6), y = whole(-1, 2), z = whole(-4, 6);
    test::add_box(scene, {x, y, z}, {x + whole(1, 4), y + whole(1, 2), z + whole(1, 4)}, whole(0, 1) == 1);
    if (whole(0, 2) == 0) scene.faces.erase(scene.faces.end() - whole(1, 6));
  }
  return scene;
}

TEST(SwitchedOff, NoFaceThatLightReachesIsDark) {
  std::size_t dark_faces = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const Scene scene = boxes_about_a_room(seed);
    const BaseMesh mesh(scene);
    const Plan plan(mesh, {});
    for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) dark_faces += !plan.may_be_lit(root);
    const Solved forced = solved(scene, {.tolerance = 0.5, .max_depth = 1, .threads = 1, .forced_on = {Feature::dark_faces}});
    for (const LeafValue& leaf : forced.leaves)
      EXPECT_TRUE(plan.may_be_lit(leaf.patch.root_face())) << "seed " << seed << ", root " << leaf.patch.root_face();
  }
  EXPECT_GT(dark_faces, 500u);
}

}  // namespace
}  // namespace alvor
