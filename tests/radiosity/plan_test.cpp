#include "radiosity/plan/plan.h"

#include "radiosity/plan/point_tree.h"
#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace alvor {
namespace {

Plan plan_of(const Scene& scene, const SolveOptions& options = {}) { return Plan(BaseMesh(scene), options); }

std::string reason_for(const Plan& plan, Feature feature) { return plan.features()[static_cast<std::size_t>(feature)].reason; }

bool says(const Plan& plan, Feature feature, const std::string& words) {
  return reason_for(plan, feature).find(words) != std::string::npos;
}

/// Returns an empty grey room whose whole ceiling is a lamp.
Scene convex_room() {
  Scene scene;
  scene.materials = {test::grey(0, 0.6), test::grey(10, 0.2)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true, {0, 1, 0, 0, 0, 0});
  return scene;
}

Scene room_with_block() {
  Scene scene = convex_room();
  test::add_box(scene, {1, 0, 1}, {2, 1, 3}, false);
  return scene;
}

/// Returns two rooms, `gap` metres apart. Only the first, x < 4, has light.
Scene two_rooms(double gap = 0) {
  Scene scene = convex_room();
  test::add_box(scene, {4 + gap, 0, 0}, {7 + gap, 3, 5}, true);
  return scene;
}

std::size_t dark_count(const Scene& scene) {
  const BaseMesh mesh(scene);
  const Plan plan(mesh, {});
  std::size_t count = 0;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) count += !plan.may_be_lit(root);
  return count;
}

TEST(PointTree, FindsPointsAboveAPlaneAsALookAtEachDoes) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points;
  for (int n = 0; n < 500; ++n) points.push_back({normal(random), 3 * normal(random), 0.1 * normal(random)});
  const PointTree tree(points);
  for (int n = 0; n < 2000; ++n) {
    const Vec3 along = normalized({normal(random), normal(random), normal(random)});
    const double height = 3 * normal(random);
    const bool any = std::ranges::any_of(points, [&](const Vec3& p) { return dot(along, p) > height; });
    EXPECT_EQ(tree.any_above(along, height), any);
  }
  EXPECT_FALSE(PointTree({}).any_above({0, 0, 1}, -1e300));
}

TEST(Plan, SaysOneSentenceAboutEachFeature) {
  const Plan plan = plan_of(room_with_block());
  ASSERT_EQ(plan.features().size(), all_features.size());
  for (std::size_t n = 0; n < all_features.size(); ++n) {
    EXPECT_EQ(plan.features()[n].feature, all_features[n]);
    EXPECT_FALSE(plan.features()[n].reason.empty()) << text(all_features[n]);
    EXPECT_FALSE(plan.features()[n].cost.empty()) << text(all_features[n]);
  }
}

TEST(Plan, GreyScenesNeedOneBand) {
  EXPECT_FALSE(plan_of(convex_room()).needs(Feature::three_bands));
  EXPECT_TRUE(says(plan_of(convex_room()), Feature::three_bands, "all 2 materials are grey"));
}

TEST(Plan, OneColouredMaterialNeedsThreeBandsIfAFaceHasIt) {
  Scene scene = convex_room();
  scene.materials.push_back({"red", {}, {0.6, 0.1, 0.05}, false});
  EXPECT_FALSE(plan_of(scene).needs(Feature::three_bands));
  scene.faces[0].material = 2;
  EXPECT_TRUE(plan_of(scene).needs(Feature::three_bands));
  EXPECT_TRUE(says(plan_of(scene), Feature::three_bands, "'red'"));
}

TEST(Plan, ColouredMediumNeedsThreeBands) {
  Scene scene = convex_room();
  scene.absorption = {0.1, 0.1, 0.1};
  EXPECT_FALSE(plan_of(scene).needs(Feature::three_bands));
  EXPECT_TRUE(plan_of(scene).needs(Feature::medium));
  scene.absorption.b = 0.2;
  EXPECT_TRUE(plan_of(scene).needs(Feature::three_bands));
}

TEST(Plan, NothingOccludesInAConvexRoomAnywhereInAnyUnit) {
  for (const double scale : {1e-3, 1.0, 1e5})
    for (const double away : {0.0, 1e4}) {
      Scene scene = convex_room();
      for (Vec3& vertex : scene.vertices) vertex = scale * (vertex + Vec3{away, away, -away});
      EXPECT_FALSE(plan_of(scene).needs(Feature::occlusion)) << scale << ' ' << away;
    }
}

TEST(Plan, ABlockInTheRoomOccludes) { EXPECT_TRUE(plan_of(room_with_block()).needs(Feature::occlusion)); }

TEST(Plan, ALampBelowTheCeilingOccludesTheCeiling) {
  Scene scene = convex_room();
  scene.materials.push_back(test::grey(50, 0));
  test::add_polygon(scene, {{1, 2.9, 1}, {2, 2.9, 1}, {2, 2.9, 2}, {1, 2.9, 2}}, 2);
  EXPECT_TRUE(plan_of(scene).needs(Feature::occlusion));
}

TEST(Plan, PlatesThatFaceEachOtherHaveNothingBetween) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(1, 0.5)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}, 0);
  test::add_polygon(scene, {{0, 1, 0}, {1, 1, 0}, {1, 1, 1}, {0, 1, 1}}, 1);
  EXPECT_FALSE(plan_of(scene).needs(Feature::occlusion));
}

TEST(Plan, BlackScenesNeedNoRowsAndNoAmbientTerm) {
  const Scene scene = test::black(room_with_block());
  EXPECT_FALSE(plan_of(scene).needs(Feature::indirect_rows));
  EXPECT_FALSE(plan_of(scene).needs(Feature::ambient_display));
  EXPECT_TRUE(plan_of(room_with_block()).needs(Feature::indirect_rows));
}

TEST(Plan, BlackFurnacesStillNeedRowsBecauseTheseCarryEmission) {
  EXPECT_TRUE(plan_of(test::furnace(1, 0)).needs(Feature::indirect_rows));
}

TEST(Plan, WithoutLightNothingIsNeeded) {
  Scene scene = room_with_block();
  scene.materials[1].emission = {};
  const Plan plan = plan_of(scene);
  EXPECT_FALSE(plan.has_light());
  for (const Feature feature : all_features) EXPECT_FALSE(plan.needs(feature)) << text(feature);
}

TEST(Plan, TwoSidedMaterialsNeedBackSides) {
  Scene scene = convex_room();
  EXPECT_FALSE(plan_of(scene).needs(Feature::back_sides));
  scene.materials[0].two_sided = true;
  EXPECT_TRUE(says(plan_of(scene), Feature::back_sides, "5 of 6 faces have a back side"));
}

TEST(Plan, DepthZeroNeedsNoRefinement) {
  EXPECT_FALSE(plan_of(convex_room(), {.max_depth = 0}).needs(Feature::refinement));
  EXPECT_TRUE(plan_of(convex_room(), {.max_depth = 1}).needs(Feature::refinement));
}

TEST(Plan, WhatIsForcedStaysOnAndSaysSo) {
  const Plan plan = plan_of(convex_room(), {.forced_on = {Feature::occlusion}});
  EXPECT_TRUE(plan.needs(Feature::occlusion));
  EXPECT_TRUE(says(plan, Feature::occlusion, "asked for"));
  EXPECT_FALSE(plan.needs(Feature::three_bands));
}

TEST(Plan, AllFacesOfALitRoomMayBeLit) {
  EXPECT_EQ(dark_count(convex_room()), 0u);
  EXPECT_EQ(dark_count(test::furnace(1, 0.5)), 0u);
}

TEST(Plan, OnlyTheUndersideOfABlockOnTheFloorIsDark) { EXPECT_EQ(dark_count(room_with_block()), 1u); }

TEST(Plan, RoomsBehindClosedWallsAreDark) {
  EXPECT_EQ(dark_count(two_rooms()), 6u);
  EXPECT_EQ(dark_count(two_rooms(0.5)), 6u);
}

TEST(Plan, TwoSidedWallsAreClosedToo) {
  Scene scene = two_rooms(0.5);
  scene.materials[0].two_sided = true;
  EXPECT_EQ(dark_count(scene), 5u + 12u);  // five backs of the first room, and all faces of the other
}

TEST(Plan, FurnitureOfADarkRoomIsDarkToo) {
  Scene scene = two_rooms();
  test::add_box(scene, {5, 0, 1}, {6, 1, 2}, false);
  EXPECT_EQ(dark_count(scene), 12u);
}

TEST(Plan, AnOpenWallLetsLightThrough) {
  Scene scene = two_rooms();
  scene.faces.erase(scene.faces.begin() + 3);  // the wall of the first room at its largest x
  EXPECT_EQ(dark_count(scene), 0u);
}

TEST(Plan, AFaceThatGoesThroughTheWallOpensTheDarkRoom) {
  Scene scene = two_rooms();
  test::add_polygon(scene, {{3, 1, 1}, {3, 1, 2}, {5, 1, 2}, {5, 1, 1}});
  EXPECT_EQ(dark_count(scene), 0u);
}

TEST(Plan, OuterWallsOfALitHouseAreDarkAndDoNotOcclude) {
  Scene scene = convex_room();
  test::add_box(scene, {-0.2, -0.2, -0.2}, {4.2, 3.2, 5.2}, false);
  EXPECT_EQ(dark_count(scene), 6u);
  EXPECT_FALSE(plan_of(scene).needs(Feature::occlusion));
}

TEST(Plan, ASealedBoxStaysDarkInsideAndLitOutside) {
  Scene scene = convex_room();
  test::add_box(scene, {1, 1, 1}, {2, 2, 2}, false);
  test::add_box(scene, {1.1, 1.1, 1.1}, {1.9, 1.9, 1.9}, true);
  EXPECT_EQ(dark_count(scene), 6u);
}

TEST(Plan, ALampInASealedBoxLightsThatAlone) {
  Scene scene;
  scene.materials = {test::grey(0, 0.6), test::grey(10, 0.2)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true);
  test::add_box(scene, {1.1, 1.1, 1.1}, {1.9, 1.9, 1.9}, true, {0, 0, 1, 0, 0, 0});
  EXPECT_EQ(dark_count(scene), 6u);
}

}  // namespace
}  // namespace alvor
