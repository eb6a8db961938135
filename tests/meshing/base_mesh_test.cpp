#include "meshing/base_mesh.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

TEST(BaseMesh, BoxOfLooseQuadsIsWeldedAndEveryEdgeHasANeighbour) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  EXPECT_EQ(mesh.roots().size(), 6u);
  EXPECT_EQ(mesh.weld_report().welded_vertices, 24u - 8u);
  for (std::uint32_t root = 0; root < 6; ++root)
    for (int e = 0; e < 4; ++e) {
      const auto other = mesh.across(root, e);
      ASSERT_TRUE(other);
      EXPECT_FALSE(other->smooth);
      EXPECT_EQ(mesh.across(other->root, other->edge)->root, root);
      EXPECT_EQ(mesh.across(other->root, other->edge)->edge, e);
    }
}

TEST(BaseMesh, CoplanarNeighboursAreSmooth) {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{1, 0, 0}, {2, 0, 0}, {1, 1, 0}});
  const BaseMesh mesh(scene);
  ASSERT_TRUE(mesh.across(0, 1));
  EXPECT_TRUE(mesh.across(0, 1)->smooth);
  EXPECT_EQ(mesh.across(0, 1)->root, 1u);
  EXPECT_EQ(mesh.across(0, 1)->edge, 2);
  EXPECT_FALSE(mesh.across(0, 0));
}

TEST(BaseMesh, DegenerateFacesAreDroppedAndCounted) {
  Scene scene = test::furnace(1, 0.5);
  test::add_polygon(scene, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}});
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 0}, {1, 0, 0}});
  const BaseMesh mesh(scene);
  EXPECT_EQ(mesh.roots().size(), 6u);
  EXPECT_EQ(mesh.weld_report().degenerate_faces, 2u);
}

TEST(BaseMesh, SliversSurvive) {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1e-6, 0}});
  EXPECT_EQ(BaseMesh(scene).roots().size(), 1u);
}

TEST(BaseMesh, ThirdFaceOnAnEdgeIsKeptWithoutNeighbours) {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{1, 0, 0}, {0, 0, 0}, {0, -1, 0}});
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}});
  const BaseMesh mesh(scene);
  EXPECT_EQ(mesh.roots().size(), 3u);
  EXPECT_EQ(mesh.weld_report().non_manifold_faces, 1u);
  EXPECT_TRUE(mesh.across(0, 0));
  EXPECT_FALSE(mesh.across(2, 0));
}

TEST(BaseMesh, TwoSidedFacesHaveTwinsThatAreNeighboursWhereTheFrontsAre) {
  Scene scene;
  scene.materials.emplace_back().two_sided = true;
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  const BaseMesh mesh(scene);
  ASSERT_EQ(mesh.roots().size(), 4u);
  const std::uint32_t twin = mesh.roots()[0].twin;
  EXPECT_EQ(mesh.roots()[twin].twin, 0u);
  EXPECT_TRUE(mesh.roots()[twin].is_back);
  EXPECT_EQ(mesh.roots()[twin].normal, -mesh.roots()[0].normal);
  EXPECT_EQ(mesh.roots()[twin].at(0.25, 0.75), mesh.roots()[0].at(0.75, 0.25));
  for (int e = 0; e < 4; ++e) {
    const auto other = mesh.across(twin, e);
    if (!other) continue;
    EXPECT_EQ(other->root, mesh.roots()[1].twin);
    EXPECT_EQ(mesh.roots()[twin].corners[e], mesh.roots()[other->root].corners[(other->edge + 1) % 4]);
  }
}

TEST(BaseMesh, FacesBackToBackInOnePlaceAreTwinsAndRaysMeetOneOfThem) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(1, 0.2)};
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}}, 0);
  test::add_polygon(scene, {{1, 2, 0}, {1, 0, 0}, {0, 0, 0}, {0, 2, 0}}, 1);
  const BaseMesh mesh(scene);
  ASSERT_EQ(mesh.roots().size(), 2u);
  const RootPatch &front = mesh.roots()[0], &other = mesh.roots()[1];
  EXPECT_EQ(front.twin, 1u);
  EXPECT_EQ(other.twin, 0u);
  EXPECT_EQ(other.material, 1u);
  EXPECT_FALSE(front.is_behind || other.is_back);
  EXPECT_TRUE(other.is_behind);
  EXPECT_EQ(other.normal, -front.normal);
  EXPECT_EQ(other.at(0.25, 0.75), front.at(0.75, 0.25));
}

TEST(BaseMesh, OfFacesThatLieInOnePlaceAndLookTheSameWayTheFirstIsKept) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(1, 0.2)};
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {0, 2, 0}}, 0);
  test::add_polygon(scene, {{5, 0, 0}, {6, 0, 0}, {6, 2, 0}, {5, 2, 0}}, 0);
  test::add_polygon(scene, {{1, 2, 0}, {0, 2, 0}, {0, 0, 0}, {1, 0, 0}}, 1);  // starts at another corner
  const BaseMesh mesh(scene);
  ASSERT_EQ(mesh.roots().size(), 2u);
  EXPECT_EQ(mesh.roots()[0].material, 0u);
  EXPECT_EQ(mesh.weld_report().duplicates.count, 1u);
  EXPECT_EQ(mesh.weld_report().duplicates.first, 2u);
  EXPECT_EQ(mesh.weld_report().duplicates.same_place, 0u);
}

TEST(BaseMesh, APaneOnAWallIsLeftOutWhicheverComesFirst) {
  for (const std::uint32_t pane : {0u, 1u}) {
    Scene scene;
    scene.materials.resize(2);
    scene.materials[pane].regular_transmittance = {0.5, 0.5, 0.5};
    for (const std::uint32_t material : {0u, 1u})
      test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, material);
    const BaseMesh mesh(scene);
    ASSERT_EQ(mesh.roots().size(), 1u);
    EXPECT_EQ(mesh.roots()[0].material, 1 - pane);
    EXPECT_EQ(mesh.weld_report().duplicates.first, pane);
    EXPECT_EQ(mesh.weld_report().duplicates.same_place, 1 - pane);
  }
}

TEST(BaseMesh, PolygonsBecomeSeveralRootsOfOneFace) {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}});
  const BaseMesh mesh(scene);
  double area = 0;
  for (const RootPatch& root : mesh.roots()) {
    EXPECT_EQ(root.input.first, 0u);
    area += root.area;
  }
  EXPECT_NEAR(area, 5, 1e-12);
  EXPECT_EQ(mesh.weld_report().split_faces, 1u);
}

TEST(BaseMesh, VerticesThatNoFaceUsesDoNotMatter) {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {1e-3, 0, 0}, {0, 1e-3, 0}});
  scene.vertices.push_back({1e9, -1e9, 1e9});
  const BaseMesh mesh(scene);
  ASSERT_EQ(mesh.roots().size(), 1u);
  EXPECT_EQ(mesh.extent(), 1e-3);
}

TEST(BaseMesh, FacesBackToBackAreNeighboursWhereTheFrontsAre) {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}});
  test::add_polygon(scene, {{1, 1, 0}, {1, 0, 0}, {0, 0, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{2, 1, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  const BaseMesh mesh(scene);
  EXPECT_EQ(mesh.weld_report().non_manifold_faces, 0u);
  ASSERT_TRUE(mesh.across(2, 2));
  EXPECT_EQ(mesh.across(2, 2)->root, 3u);
  EXPECT_TRUE(mesh.across(2, 2)->smooth);
}

TEST(BaseMesh, BuildingOneCanBeGivenUp) {
  std::stop_source stop;
  Scene scene;
  scene.materials.push_back({});
  scene.add_polygon(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0);
  EXPECT_EQ(BaseMesh(scene, {.stop = stop.get_token()}).roots().size(), 1u);
  stop.request_stop();
  EXPECT_THROW(BaseMesh(scene, {.stop = stop.get_token()}), BuildStopped);
}

}  // namespace
}  // namespace alvor
