#include "meshing/patch_place.h"

#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

namespace alvor {
namespace {

/// Returns a quad and a triangle that share an edge and lie in one plane.
Scene quad_and_triangle() {
  Scene scene;
  scene.materials.emplace_back();
  test::add_polygon(scene, {{0, 0, 0}, {2, 0, 0}, {1.5, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{2, 0, 0}, {3, 1, 0}, {1.5, 1, 0}});
  return scene;
}

bool contains(const BaseMesh& mesh, PatchId patch, Vec3 p) {
  const PatchShape shape = shape_of(mesh, patch);
  const auto corners = corners_of(mesh, shape);
  for (int c = 0; c < shape.corner_count; ++c) {
    const Vec3 a = corners[c], b = corners[(c + 1) % shape.corner_count];
    if (cross(b - a, p - a).z < -1e-9) return false;
  }
  return true;
}

TEST(PatchPlace, ChildrenTileTheirParent) {
  const BaseMesh mesh(quad_and_triangle());
  for (const PatchId patch :
       {PatchId::root(0), PatchId::root(1), PatchId::root(1).child(3), PatchId::root(1).child(3).child(3)}) {
    double area = 0;
    for (int k = 0; k < 4; ++k) area += area_of(mesh, shape_of(mesh, patch.child(k)));
    EXPECT_NEAR(area, area_of(mesh, shape_of(mesh, patch)), 1e-12);
  }
}

TEST(PatchPlace, AQuadIsWhereWalkingDownFromItsRootLeads) {
  const BaseMesh mesh(quad_and_triangle());
  for (unsigned path = 0; path < 64; ++path) {
    PatchId patch = PatchId::root(0);
    PatchShape shape = PatchShape::whole(0, 4, mesh.roots()[0].strata_along_u);
    for (int level = 0; level < PatchId::max_level; ++level) {
      const int k = static_cast<int>((path * 0x9e3779b1u >> (2 * level)) & 3);
      patch = patch.child(k), shape = shape.child(k);
      const PatchShape found = shape_of(mesh, patch);
      EXPECT_EQ(found.first, shape.first);
      EXPECT_EQ(found.size_u, shape.size_u);
      EXPECT_EQ(found.size_v, shape.size_v);
    }
  }
  EXPECT_EQ(shape_of(mesh, PatchId::root(0)).size_u, grid_size);
}

TEST(PatchPlace, SlabsTileTheirParentSideBySide) {
  const BaseMesh mesh(quad_and_triangle());
  for (const Split how : {Split::slabs_along_u, Split::slabs_along_v})
    for (const PatchId patch : {PatchId::root(0), PatchId::root(0).child(2), PatchId::root(0).child(3, Split::slabs_along_u)}) {
      const PatchShape parent = shape_of(mesh, patch);
      double area = 0;
      for (int k = 0; k < 4; ++k) {
        const PatchShape slab = shape_of(mesh, patch.child(k, how));
        area += area_of(mesh, slab);
        EXPECT_TRUE(contains(mesh, patch, centre_of(mesh, slab)));
        const bool is_along_u = how == Split::slabs_along_u;
        EXPECT_EQ(slab.size_u, is_along_u ? parent.size_u / 4 : parent.size_u);
        EXPECT_EQ(slab.size_v, is_along_u ? parent.size_v : parent.size_v / 4);
        EXPECT_EQ(slab.first.i, parent.first.i + (is_along_u ? k * slab.size_u : 0));
        EXPECT_EQ(slab.first.j, parent.first.j + (is_along_u ? 0 : k * slab.size_v));
      }
      EXPECT_NEAR(area, area_of(mesh, parent), 1e-12);
    }
}

TEST(PatchPlace, StrataOfALongQuadLieAlongIt) {
  Scene scene;
  scene.materials.emplace_back().two_sided = true;
  test::add_polygon(scene, {{0, 0, 0}, {0.32, 0, 0}, {0.32, 0.004, 0}, {0, 0.004, 0}});
  test::add_polygon(scene, {{1, 0, 0}, {1.01, 0, 0}, {1.01, 0.05, 0}, {1, 0.05, 0}});
  const BaseMesh mesh(scene);
  ASSERT_EQ(mesh.roots().size(), 4u);
  for (std::uint32_t root = 0; root < 4; ++root) {
    const RootPatch& face = mesh.roots()[root];
    const PatchShape shape = shape_of(mesh, PatchId::root(root));
    double shortest = 1;
    Vec3 sum;
    for (int o = 0; o < strata_per_patch; ++o) {
      const Uv at = shape.stratum_centre(o);
      sum += face.at(at.u, at.v);
      for (int other = 0; other < o; ++other) {
        const Uv there = shape.stratum_centre(other);
        shortest = std::min(shortest, length(face.at(at.u, at.v) - face.at(there.u, there.v)));
      }
    }
    const bool is_strip = face.area > 1e-3;  // 32 x 0.4 cm, else 1 x 5 cm
    EXPECT_NEAR(shortest, is_strip ? 0.02 : 0.005, 1e-9) << "root " << root;
    EXPECT_NEAR(length(sum / strata_per_patch - face.at(0.5, 0.5)), 0, 1e-12);
    for (int k = 0; k < 4; ++k) {
      Uv mean{0, 0};
      for (int o = 4 * k; o < 4 * k + 4; ++o)
        mean = {mean.u + shape.stratum_centre(o).u / 4, mean.v + shape.stratum_centre(o).v / 4};
      EXPECT_NEAR(mean.u, shape.quarter_centre(k).u, 1e-12);
      EXPECT_NEAR(mean.v, shape.quarter_centre(k).v, 1e-12);
    }
  }
}

TEST(PatchPlace, FinestPatchContainsThePoint) {
  const BaseMesh mesh(quad_and_triangle());
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform;
  for (int n = 0; n < 1000; ++n)
    for (const std::uint32_t root : {0u, 1u}) {
      Uv at{uniform(random), uniform(random)};
      if (root == 1 && at.u + at.v > 1) at = {1 - at.u, 1 - at.v};
      const PatchId finest = finest_patch(mesh, root, at);
      const Vec3 p = mesh.roots()[root].at(at.u, at.v);
      for (const int level : {0, 1, 5, PatchId::max_level})
        EXPECT_TRUE(contains(mesh, finest.ancestor(level), p)) << root << ' ' << at.u << ' ' << at.v << " level " << level;
    }
}

TEST(PatchPlace, PlaceAcrossTouchesTheEdgeFromTheOtherSide) {
  const BaseMesh mesh(quad_and_triangle());
  int across_roots = 0;
  for (const PatchId patch : {PatchId::root(0), PatchId::root(0).child(1).child(3), PatchId::root(1), PatchId::root(1).child(2),
                              PatchId::root(1).child(3), PatchId::root(1).child(0).child(3)}) {
    const PatchShape shape = shape_of(mesh, patch);
    const auto corners = corners_of(mesh, shape);
    for (int e = 0; e < shape.corner_count; ++e)
      for (const double t : {0.25, 0.5, 0.75}) {
        const auto place = place_across(mesh, shape, e, t);
        if (!place) continue;
        const Vec3 on_edge = lerp(corners[e], corners[(e + 1) % shape.corner_count], t);
        const PatchShape there = shape_of(mesh, *place);
        const Uv c = there.centre();
        EXPECT_LT(length(mesh.roots()[there.root].at(c.u, c.v) - on_edge), 1e-3);
        EXPECT_FALSE(patch.contains(*place));
        across_roots += place->root_face() != patch.root_face();
      }
  }
  EXPECT_GT(across_roots, 0);
}

TEST(PatchPlace, CoordinatesThatAreNoNumbersHavePlacesToo) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  float u[places_at_once], v[places_at_once];
  for (int n = 0; n < places_at_once; ++n) u[n] = n % 2 == 0 ? nan : infinity, v[n] = n % 3 == 0 ? -infinity : nan;
  std::uint32_t quad[places_at_once], triangle[places_at_once];
  finest_quad_paths(u, v, quad);
  finest_triangle_paths(u, v, triangle);
  for (int n = 0; n < places_at_once; ++n) {
    EXPECT_TRUE(PatchId::finest(0, quad[n]).is_valid());
    EXPECT_LT(quad[n], 1u << 30);
    EXPECT_LT(triangle[n], 1u << 30);
  }
}

}  // namespace
}  // namespace alvor
