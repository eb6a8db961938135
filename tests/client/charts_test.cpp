// Tests of charts and of their places on textures.

#include "client/bake/charts.h"
#include "client/bake/chart_pages.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

namespace alvor {
namespace {

/// A mesh of triangles alone.
struct Mesh {
  std::vector<Vec3> positions;
  std::vector<MeshTriangle> triangles;
};

Mesh mesh_of(const Scene& scene) {
  Mesh mesh{scene.vertices, {}};
  for (const Face& face : scene.faces) {
    const auto corners = scene.corners_of(face);
    for (std::size_t c = 2; c < corners.size(); ++c) mesh.triangles.push_back({corners[0], corners[c - 1], corners[c]});
  }
  return mesh;
}

Mesh globe() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_globe(scene, {0, 0, 0}, 1, 3, 0);
  return mesh_of(scene);
}

/// A ramp that winds twice about an axis: seen from above it lies over itself, and no edge of it is sharp.
Mesh spiral_ramp() {
  Mesh mesh;
  constexpr int steps = 96;
  for (int n = 0; n <= steps; ++n) {
    const double angle = 4 * std::numbers::pi * n / steps;
    for (const double radius : {1.0, 2.0})
      mesh.positions.push_back({radius * std::cos(angle), 0.1 * angle, -radius * std::sin(angle)});
  }
  for (std::uint32_t n = 0; n < steps; ++n) {
    mesh.triangles.push_back({2 * n, 2 * n + 1, 2 * n + 3});
    mesh.triangles.push_back({2 * n, 2 * n + 3, 2 * n + 2});
  }
  return mesh;
}

double area_of(const std::array<std::array<double, 2>, 3>& t) {
  return ((t[1][0] - t[0][0]) * (t[2][1] - t[0][1]) - (t[1][1] - t[0][1]) * (t[2][0] - t[0][0])) / 2;
}

/// Returns how many triangles of a chart cover a point of its plane.
int cover(const ChartedMesh& mesh, const Chart& chart, const std::array<double, 2>& p) {
  int count = 0;
  for (const std::uint32_t t : chart.triangles) {
    std::array<std::array<double, 2>, 3> flat;
    for (std::size_t c = 0; c < 3; ++c) flat[c] = mesh.flat[mesh.triangles[t][c]];
    const double whole = area_of(flat);
    bool is_inside = true;
    for (std::size_t c = 0; c < 3; ++c) {
      auto part = flat;
      part[c] = p;
      is_inside = is_inside && area_of(part) / whole > 1e-9;
    }
    count += is_inside;
  }
  return count;
}

void expect_charts_are_sound(const Mesh& mesh) {
  const ChartedMesh charted = cut_into_charts(mesh.positions, mesh.triangles);
  std::vector<int> seen(mesh.triangles.size());
  for (std::size_t c = 0; c < charted.charts.size(); ++c) {
    const Chart& chart = charted.charts[c];
    EXPECT_NEAR(dot(chart.u, chart.v), 0, 1e-9);
    for (const std::uint32_t t : chart.triangles) {
      ++seen[t];
      std::array<std::array<double, 2>, 3> flat;
      for (std::size_t k = 0; k < 3; ++k) {
        flat[k] = charted.flat[charted.triangles[t][k]];
        EXPECT_GE(flat[k][0], -1e-9);
        EXPECT_LE(flat[k][0], chart.wide + 1e-9);
        EXPECT_GE(flat[k][1], -1e-9);
        EXPECT_LE(flat[k][1], chart.high + 1e-9);
        EXPECT_EQ(charted.vertex_chart[charted.triangles[t][k]], c);
        EXPECT_EQ(charted.source[charted.triangles[t][k]], mesh.triangles[t][k]);
      }
      const auto& [a, b, d] = mesh.triangles[t];
      const double area = length(cross(mesh.positions[b] - mesh.positions[a], mesh.positions[d] - mesh.positions[a])) / 2;
      EXPECT_GT(area_of(flat), 0.7 * area) << "triangle " << t;
    }
    for (int n = 0; n < 400; ++n)
      EXPECT_LE(cover(charted, chart, {chart.wide * (n % 20 + 0.517) / 20, chart.high * (n / 20 + 0.483) / 20}), 1)
          << "chart " << c;
  }
  EXPECT_TRUE(std::ranges::all_of(seen, [](int times) { return times == 1; }));
}

TEST(Charts, OfABoxAreItsSides) {
  const Mesh box = mesh_of(test::furnace(1, 0.5));
  expect_charts_are_sound(box);
  EXPECT_EQ(cut_into_charts(box.positions, box.triangles).charts.size(), 6u);
}

TEST(Charts, OfAGlobeShrinkNoTriangleMuch) {
  expect_charts_are_sound(globe());
  const Mesh mesh = globe();
  EXPECT_LE(cut_into_charts(mesh.positions, mesh.triangles).charts.size(), 40u);
}

TEST(Charts, OfASpiralRampDoNotLieOverThemselves) { expect_charts_are_sound(spiral_ramp()); }

TEST(Charts, LeaveOutTrianglesWithoutArea) {
  const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}};
  const std::vector<MeshTriangle> triangles{{0, 1, 2}, {0, 1, 3}, {0, 0, 0}};
  const ChartedMesh charted = cut_into_charts(positions, triangles);
  EXPECT_EQ(charted.charts.size(), 1u);
  EXPECT_EQ(charted.chart_of[1], ChartedMesh::no_chart);
  EXPECT_EQ(charted.chart_of[2], ChartedMesh::no_chart);
  EXPECT_TRUE(cut_into_charts({}, {}).charts.empty());
}

TEST(Charts, AreThoseOfGivenCoordinatesUnlessTheyOverlap) {
  const std::vector<Vec3> positions{{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}};
  const std::vector<MeshTriangle> triangles{{0, 1, 2}, {0, 2, 3}};
  const std::vector<std::array<float, 2>> points{{0.1F, 0.9F}, {0.5F, 0.9F}, {0.5F, 0.7F}, {0.1F, 0.7F}};
  const auto charted = chart_of_points(positions, triangles, points);
  ASSERT_TRUE(charted);
  ASSERT_EQ(charted->charts.size(), 1u);
  EXPECT_NEAR(charted->charts[0].wide, 4, 1e-5);
  EXPECT_NEAR(charted->charts[0].high, 2, 1e-5);
  for (std::size_t v = 0; v < positions.size(); ++v) {
    EXPECT_NEAR(charted->flat[v][0], positions[v].x, 1e-5);
    EXPECT_NEAR(charted->flat[v][1], positions[v].y, 1e-5);
  }
  auto folded = points;
  folded[3] = {0.5F, 0.85F};  // the second triangle lies over the first
  EXPECT_FALSE(chart_of_points(positions, triangles, folded));
  auto one_place = points;
  one_place[3] = one_place[2];
  EXPECT_FALSE(chart_of_points(positions, triangles, one_place));
  folded[0][0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(chart_of_points(positions, triangles, folded));
}

std::vector<ChartSize> many_sizes() {
  std::vector<ChartSize> sizes;
  for (int n = 0; n < 300; ++n) sizes.push_back({0.05 + 0.01 * (n * 37 % 101), 0.03 + 0.02 * (n * 53 % 89)});
  sizes.push_back({0, 0});
  return sizes;
}

void expect_no_overlap(const ChartPages& pages, std::size_t charts) {
  ASSERT_EQ(pages.places.size(), charts);
  std::set<std::array<int, 3>> taken;
  for (const ChartPlace& place : pages.places) {
    ASSERT_GE(place.x, 0);
    ASSERT_GE(place.y, 0);
    ASSERT_LE(place.x + place.wide, pages.size);
    ASSERT_LE(place.y + place.high, pages.size);
    ASSERT_LT(place.page, pages.count);
    for (int y = 0; y < place.high; ++y)
      for (int x = 0; x < place.wide; ++x) ASSERT_TRUE(taken.insert({place.page, place.x + x, place.y + y}).second);
  }
}

TEST(ChartPages, HoldEachChartOnceAndFillThePage) {
  const auto sizes = many_sizes();
  const auto pages = place_charts(sizes, {.size = 512});
  ASSERT_TRUE(pages);
  EXPECT_EQ(pages->count, 1);
  expect_no_overlap(*pages, sizes.size());
  double used = 0;
  for (const ChartPlace& place : pages->places) used += double(place.wide) * place.high;
  EXPECT_GT(used, 0.6 * 512 * 512);
}

TEST(ChartPages, AreAsManyAsADensityTakesOrNone) {
  const auto sizes = many_sizes();
  const auto pages = place_charts(sizes, {.size = 256, .texels_per_metre = 100});
  ASSERT_TRUE(pages);
  EXPECT_GT(pages->count, 1);
  expect_no_overlap(*pages, sizes.size());
  EXPECT_FALSE(place_charts(sizes, {.size = 256, .texels_per_metre = 1000}));  // one chart alone is larger than a page
  EXPECT_FALSE(place_charts(sizes, {.size = 256, .texels_per_metre = 100, .most_pages = 1}));
}

}  // namespace
}  // namespace alvor
