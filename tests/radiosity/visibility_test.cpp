#include "radiosity/rays/visibility.h"

#include "radiosity/rays/triangle_caster.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <limits>

namespace alvor {
namespace {

RayPacket packet(Vec3 origin, Vec3 direction, float t_max) {
  RayPacket rays;
  for (std::size_t r = 0; r < RayPacket::width; ++r) rays.set(r, origin, direction, t_max);
  return rays;
}

TEST(Visibility, ClosestHitNamesTheRootPatchAmongQuadsAndTriangles) {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
  test::add_polygon(scene, {{0, 0, 2}, {1, 0, 2}, {1, 1, 2}, {0, 1, 2}});
  const BaseMesh mesh(scene);
  const LocalFrame frame{mesh.centre(), mesh.extent()};
  const Visibility visibility(mesh, frame);
  const auto infinity = std::numeric_limits<float>::infinity();
  const auto first_root = [&](Vec3 from, Vec3 towards) {
    const RayPacket rays = packet(frame.to_local(from), towards, infinity);
    HitPacket hits;
    visibility.closest_hits({&rays, 1}, {&hits, 1});
    return hits.root[7];
  };
  EXPECT_EQ(first_root({0.25, 0.25, 0.5}, {0, 0, -1}), 0u);
  EXPECT_EQ(first_root({0.25, 0.25, 0.5}, {0, 0, 1}), 1u);
  EXPECT_EQ(first_root({0.9, 0.9, 0.5}, {0, 0, 1}), 2u);
  EXPECT_EQ(first_root({0.9, 0.9, 0.5}, {1, 0, 0}), HitPacket::nothing);
}

TEST(Visibility, OcclusionEndsAtTMax) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  const LocalFrame frame{mesh.centre(), mesh.extent()};
  const Visibility visibility(mesh, frame);
  for (const auto& [t_max, expected] : {std::pair{0.2f, 0}, std::pair{2.0f, 0xffff}}) {
    const RayPacket rays = packet({0, 0, 0}, {0, 0, 1}, t_max);
    std::uint16_t blocked = 1;
    visibility.occlusions({&rays, 1}, {&blocked, 1});
    EXPECT_EQ(blocked, expected);
  }
}

/// Returns a wall at z = 0 with panes before it at z = 1 and 3, and one behind it at z = -1.
Scene wall_behind_panes() {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[1].regular_transmittance = {0.5, 0.5, 0.5};
  scene.materials[2].regular_transmittance = {1, 0.5, 0.25};
  const auto add = [&](double z, std::uint32_t material) {
    test::add_polygon(scene, {{0, 0, z}, {1, 0, z}, {1, 1, z}, {0, 1, z}}, material);
  };
  add(0, 0), add(3, 1), add(1, 2), add(-1, 1);
  return scene;
}

TEST(Visibility, RaysCrossThePanesBeforeTheirHitInOrderAndNoneBehindIt) {
  const BaseMesh mesh(wall_behind_panes());
  const LocalFrame frame{mesh.centre(), mesh.extent()};
  const Visibility visibility(mesh, frame);
  RayPacket rays = packet(frame.to_local({0.3, 0.4, 5}), {0, 0, -1}, std::numeric_limits<float>::infinity());
  rays.set(5, frame.to_local({0.3, 0.4, 2}), {0, 0, 1}, std::numeric_limits<float>::infinity());
  HitPacket hits;
  std::vector<Crossing> crossings(3);  // of an earlier packet
  visibility.closest_hits({&rays, 1}, {&hits, 1}, {&crossings, 1});
  EXPECT_EQ(hits.root[0], 0u);
  EXPECT_EQ(hits.root[5], HitPacket::nothing);
  ASSERT_EQ(crossings.size(), 2 * 15 + 1u);
  EXPECT_EQ(crossings[0].root, 1u);
  EXPECT_EQ(crossings[1].root, 2u);
  EXPECT_LT(crossings[0].t, crossings[1].t);
  EXPECT_EQ(crossings[10].lane, 5u);
  EXPECT_EQ(crossings[10].root, 1u);
  EXPECT_NEAR(crossings[10].t * mesh.extent(), 1, 1e-5);
}

TEST(Visibility, ShadowRaysTakeTheTintOfThePanesOnTheirWay) {
  const BaseMesh mesh(wall_behind_panes());
  const LocalFrame frame{mesh.centre(), mesh.extent()};
  const Visibility visibility(mesh, frame);
  const RayPacket rays = packet(frame.to_local({0.3, 0.4, 5}), Vec3{0, 0, -4.5} / mesh.extent(), 1);
  std::uint16_t blocked = 1;
  Visibility::Tints tints;
  visibility.occlusions({&rays, 1}, {&blocked, 1}, {&tints, 1});
  EXPECT_EQ(blocked, 0);
  for (const RgbF& tint : tints) EXPECT_EQ(tint, (RgbF{0.5, 0.25, 0.125}));
  const RayPacket further = packet(frame.to_local({0.3, 0.4, 5}), Vec3{0, 0, -5.5} / mesh.extent(), 1);
  visibility.occlusions({&further, 1}, {&blocked, 1}, {&tints, 1});
  EXPECT_EQ(blocked, 0xffff);
}

TEST(TriangleCaster, NearestFindsTheSurfaceFacingTheSameWay) {
  const std::vector<Vec3> positions{{0, 0, 1e7}, {4, 0, 1e7}, {0, 4, 1e7}, {0, 0, 1e7 + 1}, {4, 0, 1e7 + 1}, {0, 4, 1e7 + 1}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {3, 5, 4}};
  const TriangleCaster caster(positions, triangles);
  const auto up = caster.nearest({1, 1, 1e7 + 0.9}, {0, 0, 1});
  ASSERT_TRUE(up);
  EXPECT_EQ(up->triangle, 0u);
  EXPECT_NEAR(up->distance, 0.9, 1e-6);
  EXPECT_NEAR(up->u, 0.25, 1e-6);
  const auto down = caster.nearest({1, 1, 1e7 + 0.1}, {0, 0, -1});
  ASSERT_TRUE(down);
  EXPECT_EQ(down->triangle, 1u);
  EXPECT_FALSE(caster.nearest({1, 1, 1e7}, {1, 0, 0}));
}

TEST(TriangleCaster, CastReturnsTheFirstTriangleAlongTheRay) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}, {3, 4, 5}};
  const TriangleCaster caster(positions, triangles);
  const auto hit = caster.cast({0.25, 0.25, 5}, {0, 0, -1});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->triangle, 1u);
  EXPECT_NEAR(hit->distance, 4, 1e-5);
  EXPECT_FALSE(caster.cast({5, 5, 5}, {0, 0, -1}));
}

TEST(TriangleCaster, OnlyWhatLiesBetweenTwoPointsBlocks) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 1, 2}};
  for (const Traversal traversal : {Traversal::fast, Traversal::watertight}) {
    const TriangleCaster caster(positions, triangles, traversal);
    EXPECT_TRUE(caster.is_blocked({0.25, 0.25, 5}, {0.25, 0.25, -5}));
    EXPECT_TRUE(caster.is_blocked({0.25, 0.25, -5}, {0.25, 0.25, 1e-4}));
    EXPECT_FALSE(caster.is_blocked({0.25, 0.25, 5}, {0.25, 0.25, 1e-4}));
    EXPECT_FALSE(caster.is_blocked({2, 2, 5}, {2, 2, -5}));
  }
}

}  // namespace
}  // namespace alvor
