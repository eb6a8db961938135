#include "radiosity/rays/visibility.h"

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
  const Visibility visibility(mesh.roots(), frame);
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
  const Visibility visibility(mesh.roots(), frame);
  for (const auto& [t_max, expected] : {std::pair{0.2f, 0}, std::pair{2.0f, 0xffff}}) {
    const RayPacket rays = packet({0, 0, 0}, {0, 0, 1}, t_max);
    std::uint16_t blocked = 1;
    visibility.occlusions({&rays, 1}, {&blocked, 1});
    EXPECT_EQ(blocked, expected);
  }
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
