#include "meshing/display_mesh.h"

#include "meshing/patch_forest.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <tuple>

namespace alvor {
namespace {

std::vector<LeafValue> refined_leaves(const BaseMesh& mesh, const std::function<RgbF(Vec3)>& field) {
  PatchForest forest(mesh);
  std::vector<NodeIndex> split;
  for (std::size_t n = 0; n < 80; ++n)
    forest.split(forest.leaves()[n * 5 % forest.leaf_count()], {}, split, static_cast<Split>(n % 4 == 3 ? 0 : n % 4));
  std::vector<LeafValue> values;
  for (const NodeIndex leaf : forest.leaves()) {
    const Uv c = forest.shape(leaf).centre();
    values.push_back({forest.id(leaf), field(mesh.roots()[forest.id(leaf).root_face()].at(c.u, c.v))});
  }
  std::ranges::sort(values, {}, &LeafValue::patch);
  return values;
}

using Point = std::tuple<double, double, double>;

TEST(DisplayMesh, ClosedRoomHasNoCracksAtHangingVertices) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  const DisplayMesh display = build_display_mesh(mesh, refined_leaves(mesh, [](Vec3) { return RgbF{1, 1, 1}; }));
  std::map<std::pair<Point, Point>, int> sides;
  const auto point = [&](std::uint32_t v) {
    const Vec3 p = display.positions[v];
    return Point{p.x, p.y, p.z};
  };
  for (const auto& t : display.triangles)
    for (int k = 0; k < 3; ++k) ++sides[{point(t[k]), point(t[(k + 1) % 3])}];
  for (const auto& [side, count] : sides) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(sides.contains({side.second, side.first})) << "an open edge, to the last bit of its positions";
  }
}

TEST(DisplayMesh, TheSidesOfATwoSidedFaceLieApartAndNoFartherThanAPixelShows) {
  Scene scene = test::furnace(0, 0.5);
  scene.materials.push_back({"curtain", {}, {0.5, 0.5, 0.5}, true});
  test::add_polygon(scene, {{1, 0.5, 2}, {2, 0.5, 2}, {2, 1.5, 2}, {1, 1.5, 2}}, 1);
  const BaseMesh mesh(scene);
  const DisplayMesh display = build_display_mesh(mesh, refined_leaves(mesh, [](Vec3) { return RgbF{1, 1, 1}; }));
  int front = 0, back = 0;
  for (std::size_t v = 0; v < display.positions.size(); ++v) {
    const Vec3 p = display.positions[v];
    if (std::abs(p.z - 2) > 0.001 || p.x == 0 || p.x == 3 || p.y == 0 || p.y == 2) continue;
    const double ahead = (p.z - 2) * display.normals[v].z;
    EXPECT_GT(ahead, 1e-5);
    EXPECT_LT(ahead, 1e-4 * mesh.extent());
    ++(display.normals[v].z > 0 ? front : back);
  }
  EXPECT_GT(front, 4);
  EXPECT_GT(back, 4);
}

TEST(DisplayMesh, NoSideOfATwoSidedFaceReachesBehindIt) {
  // Two walls on a slab, with a common corner: edges of three and more faces, and rims where two sides meet.
  Scene scene;
  scene.materials.push_back({"concrete", {}, {0.5, 0.5, 0.5}, true});
  test::add_box(scene, {-0.15, -0.2, -5.15}, {6.15, 0, 0.15}, false);
  test::add_box(scene, {-0.15, 0, 0}, {6.15, 2.8, 0.15}, false);
  test::add_box(scene, {-0.15, 0, -5}, {0, 2.8, 0}, false);
  const BaseMesh mesh(scene);
  for (const bool is_refined : {false, true}) {
    std::vector<LeafValue> leaves;
    for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) leaves.push_back({PatchId::root(root), {1, 1, 1}});
    if (is_refined) leaves = refined_leaves(mesh, [](Vec3) { return RgbF{1, 1, 1}; });
    const DisplayMesh display = build_display_mesh(mesh, leaves);
    for (const auto& [a, b, c] : display.triangles) {
      const Vec3 middle = display.positions[a];  // of a leaf, moved straight to the front
      const Vec3 normal = display.normals[a];
      for (const std::uint32_t corner : {b, c})
        EXPECT_GE(dot(display.positions[corner] - middle, normal), -3e-5 * mesh.extent()) << "moved through its own face";
    }
  }
}

TEST(DisplayMesh, TheFoldsOfACurtainStayClosed) {
  Scene scene;
  scene.materials.push_back({"curtain", {}, {0.5, 0.5, 0.5}, true});
  const std::array<Vec3, 4> rod{{{0, 0, 0}, {1, 0, 0.5}, {2, 0, -0.3}, {3, 0, 0.4}}};
  const Vec3 fall{0, 2, 0};
  for (int n = 0; n < 3; ++n) test::add_polygon(scene, {rod[n], rod[n + 1], rod[n + 1] + fall, rod[n] + fall});
  const BaseMesh mesh(scene);
  const DisplayMesh display = build_display_mesh(mesh, refined_leaves(mesh, [](Vec3) { return RgbF{1, 1, 1}; }));
  // On each fold and side, the vertices of both faces must lie in one place.
  for (const Vec3& fold : {rod[1], rod[2]}) {
    int left = 0, right = 0;
    std::set<std::pair<int, int>> places;
    for (std::size_t v = 0; v < display.positions.size(); ++v) {
      const Vec3 from_fold = display.positions[v] - fold;
      if (std::hypot(from_fold.x, from_fold.z) > 0.01) continue;
      places.insert({static_cast<int>(std::lround(from_fold.x * 1e9)), static_cast<int>(std::lround(from_fold.z * 1e9))});
      ++(display.normals[v].z > 0 ? left : right);
    }
    EXPECT_GT(left, 3);
    EXPECT_GT(right, 3);
    EXPECT_EQ(places.size(), 2u);
  }
}

TEST(DisplayMesh, TellsTheFaceAndTheMaterialOfEachTriangle) {
  const Scene scene = test::coloured_room();
  const BaseMesh base(scene);
  PatchForest forest(base);
  std::vector<LeafValue> leaves;
  for (std::uint32_t root = 0; root < base.roots().size(); ++root) leaves.push_back({PatchId::root(root), {1, 1, 1}});
  const DisplayMesh mesh = build_display_mesh(base, leaves);
  ASSERT_EQ(mesh.faces.size(), base.roots().size());
  std::size_t triangle = 0;
  for (const FaceTriangles& run : mesh.faces) {
    const Face& face = scene.faces[run.faces.first];
    EXPECT_EQ(run.material, face.material);
    const Vec3 corner = scene.vertices[scene.corners_of(face)[0]];
    for (std::uint32_t n = 0; n < run.count; ++n, ++triangle) {
      const std::uint32_t vertex = mesh.triangles[triangle][0];
      EXPECT_NEAR(dot(mesh.positions[vertex] - corner, mesh.normals[vertex]), 0, 1e-3) << "triangle " << triangle;
    }
  }
  EXPECT_EQ(triangle, mesh.triangles.size());
  EXPECT_EQ(mesh.materials.size(), scene.materials.size());
}

TEST(DisplayMesh, UniformIrradianceStaysUniform) {
  const BaseMesh mesh(test::furnace(2, 0.5));
  const DisplayMesh display = build_display_mesh(mesh, refined_leaves(mesh, [](Vec3) { return RgbF{4, 4, 4}; }));
  for (const RgbF& h : display.irradiance) EXPECT_EQ(h, (RgbF{4, 4, 4}));
  for (const RgbF& b : display.radiosity) EXPECT_EQ(b, (RgbF{4, 4, 4}));
}

TEST(DisplayMesh, ValuesDoNotBleedAcrossACrease) {
  const BaseMesh mesh(test::furnace(0, 0.5));
  const auto leaves = refined_leaves(mesh, [](Vec3 p) { return p.y == 0 ? RgbF{1, 1, 1} : RgbF{7, 7, 7}; });
  const DisplayMesh display = build_display_mesh(mesh, leaves);
  for (std::size_t v = 0; v < display.positions.size(); ++v)
    EXPECT_EQ(display.irradiance[v].r, display.normals[v].y > 0.5 ? 1 : 7);
}

TEST(DisplayMesh, LeavesWhereNothingArrivesDoNotDarkenTheirNeighbours) {
  Scene scene;
  scene.materials.push_back(test::grey(0, 0.5));
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  const BaseMesh mesh(scene);
  const PatchId root = PatchId::root(0);
  const std::vector<LeafValue> leaves{
      {root.child(0), {3, 3, 3}}, {root.child(1), {0, 0, 0}}, {root.child(2), {3, 3, 3}}, {root.child(3), {3, 3, 3}}};
  const DisplayMesh display = build_display_mesh(mesh, leaves);
  int lit = 0;
  for (std::size_t v = 0; v < display.positions.size(); ++v) lit += display.irradiance[v].r == 3;
  EXPECT_EQ(lit, 3 + 8);  // three centres, and all corners except the one that only the dark leaf has
}

TEST(DisplayMesh, EachTriangleStartsAtALeafCentreAndFacesTheFront) {
  const BaseMesh mesh(test::furnace(1, 0.5));
  const auto leaves = refined_leaves(mesh, [](Vec3) { return RgbF{1, 1, 1}; });
  const DisplayMesh display = build_display_mesh(mesh, leaves);
  std::set<std::uint32_t> centres;
  for (const auto& t : display.triangles) {
    centres.insert(t[0]);
    const Vec3 a = display.positions[t[0]], b = display.positions[t[1]], c = display.positions[t[2]];
    EXPECT_GT(dot(cross(b - a, c - a), display.normals[t[0]]), 0);
  }
  EXPECT_EQ(centres.size(), leaves.size());
}

}  // namespace
}  // namespace alvor
