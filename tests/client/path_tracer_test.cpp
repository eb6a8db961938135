// Tests of path tracing against closed forms and against independent Monte Carlo results.

#include "client/verify/irradiance_estimate.h"
#include "client/verify/surface_points.h"
#include "import/apart/scene_file.h"
#include "tests/client/path_tracing.h"
#include "tests/textures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>
#include <vector>

namespace alvor {
namespace {

using test::add_polygon;
using test::grey;

TEST(PathTracer, FurnaceIsUniformUpToItsCorners) {
  for (const double reflectance : {0.0, 0.5, 0.9}) {
    const Scene scene = test::furnace(1 - reflectance, reflectance);
    for (const Vec3 place : {Vec3{1.5, 0, 2}, {0.001, 0, 0.001}, {2.9, 0, 0.5}}) {
      const auto estimate = traced(scene, {place, {0, 1, 0}});
      EXPECT_NEAR(estimate.mean().mean(), 1, sure * error_of(estimate)) << reflectance;
      EXPECT_LT(error_of(estimate), 0.02) << reflectance;
    }
  }
}

TEST(PathTracer, AGapIsNotEnclosedHoweverNarrow) {
  for (const double gap : {1e-4, 1e-3, 1e-2}) {
    Scene scene = test::furnace(1, 0.5);
    test::add_box(scene, {1, gap, 1}, {2, 1, 2}, false);
    const PathTracer tracer(scene);
    EXPECT_FALSE(tracer.is_enclosed({{1.5, 0, 1.5}, {0, 1, 0}}, 64, PathRandom(1, 2, 3))) << gap;
  }
  Scene scene = test::furnace(1, 0.5);
  test::add_box(scene, {1, 0, 1}, {2, 1, 2}, false);
  EXPECT_TRUE(PathTracer(scene).is_enclosed({{1.5, 0, 1.5}, {0, 1, 0}}, 64, PathRandom(1, 2, 3)));
}

TEST(PathTracer, UnderASeatWhoseEndsAreTheFrontsOfItsArmsIsEnclosed) {
  for (const double gap : {0.0, 1e-3}) {
    Scene scene = test::furnace(1, 0.5);
    for (const double z : {0.5, 2.0}) test::add_box(scene, {1, 0, z}, {2, 0.6, z + 0.2}, false);
    test::add_box(scene, {1.8, 0, 0.7}, {2, 0.9, 2}, false);
    test::add_polygon(scene, {{1, 0.4, 0.7}, {1, 0.4, 2}, {1.8, 0.4, 2}, {1.8, 0.4, 0.7}}, 0);
    test::add_polygon(scene, {{1, gap, 0.7}, {1, gap, 2}, {1, 0.4, 2}, {1, 0.4, 0.7}}, 0);
    const PathTracer tracer(scene);
    for (const double x : {1.01, 1.4, 1.7})
      EXPECT_EQ(tracer.is_enclosed({{x, 0, 1.3}, {0, 1, 0}}, 256, PathRandom(1, 2, 3)), gap == 0) << x << ' ' << gap;
  }
}

TEST(PathTracer, AGapUnderAHollowBoxIsNotEnclosedWhereSomeWallsAreBacks) {
  Scene scene = test::furnace(1, 0.5);
  const Face wall = scene.faces[0];
  const auto corners = scene.corners.begin() + wall.first_corner;
  std::reverse(corners, corners + wall.corner_count);
  Scene box;
  constexpr double gap = 1e-3;
  test::add_box(box, {1, gap, 1}, {2, 1, 2}, false);
  for (const Face& face : box.faces) {
    std::vector<Vec3> ring;
    for (const std::uint32_t vertex : box.corners_of(face)) ring.push_back(box.vertices[vertex]);
    if (std::ranges::any_of(ring, [](Vec3 corner) { return corner.y > gap; })) scene.add_polygon(ring, 0);
  }
  EXPECT_FALSE(PathTracer(scene).is_enclosed({{1.5, 0, 1.5}, {0, 1, 0}}, 256, PathRandom(1, 2, 3)));
}

TEST(PathTracer, FacesBackToBackInOnePlaceAreBothSeen) {
  // A closed furnace cut in two by a partition of two faces in one place: irradiance must be the same as without it.
  Scene scene = test::furnace(0.5, 0.5);
  add_polygon(scene, {{1, 0, 0}, {1, 2, 0}, {1, 2, 4}, {1, 0, 4}}, 0);
  add_polygon(scene, {{1, 0, 4}, {1, 2, 4}, {1, 2, 0}, {1, 0, 0}}, 0);
  for (const Vec3 place : {Vec3{0.5, 0, 2}, {2, 0, 1}, {1.01, 0, 2}, {0.99, 0, 3}}) {
    const auto estimate = traced(scene, {place, {0, 1, 0}});
    EXPECT_NEAR(estimate.mean().mean(), 1, sure * error_of(estimate));
  }
}

// All surfaces of a furnace are equally bright. A pane that absorbs nothing reflects exactly as much light as it keeps from going
// through, so it changes nothing between them.
TEST(PathTracer, PanesThatAbsorbNothingChangeNothingInAFurnace) {
  for (const double reflectance : {0.0, 0.3, 0.7}) {
    Scene scene = test::furnace(0.5, 0.5);
    const double through = 1 - reflectance;
    scene.materials.push_back({"pane", {}, {reflectance, reflectance, reflectance}, true, {through, through, through}});
    add_polygon(scene, {{1, 0.2, 0.5}, {1, 1.8, 0.5}, {1.3, 1.8, 3.5}, {1.3, 0.2, 3.5}}, 1);
    add_polygon(scene, {{2, 0.2, 0.5}, {2, 1.8, 0.5}, {2, 1.8, 3.5}, {2, 0.2, 3.5}}, 1);
    const auto estimate = traced(scene, {{1.5, 0, 2}, {0, 1, 0}});
    EXPECT_NEAR(estimate.mean().mean(), 1, sure * error_of(estimate)) << reflectance;
  }
}

TEST(PathTracer, ManyPanesDimByTheirProductWhereverTheyLie) {
  for (const int panes : {2, 3, 20}) {
    Scene scene;
    scene.materials = {grey(3, 0)};
    add_ceiling(scene, 3, 1, 0);  // light comes from all slants, parallel to the panes
    add_black_floor(scene, 1);
    const SurfacePoint point{{0, 0, 0}, {0, 0, 1}};
    const auto clear = traced(scene, point);
    scene.materials.push_back({"pane", {}, {}, false, {0.9, 0.9, 0.9}});
    for (int n = 0; n < panes; ++n) add_ceiling(scene, 8, 0.9 - 0.8 * n / panes, 2);
    const auto estimate = traced(scene, point);
    const double expected = std::pow(0.9, panes) * clear.mean().r;
    EXPECT_NEAR(estimate.mean().r, expected, sure * error_of(estimate) + 1e-3 * expected) << panes;
  }
}

TEST(PathTracer, NoLightPassesAWallThatAPaneLiesOn) {
  Scene scene = test::furnace(1, 0.5);  // light outside of it would be missed
  scene.materials.push_back({"pane", {}, {}, false, {1, 1, 1}});
  add_polygon(scene, {{0.5, 0, 1}, {0.5, 0, 3}, {2.5, 0, 3}, {2.5, 0, 1}}, 1);
  const auto estimate = traced(scene, {{1.5, 2, 2}, {0, -1, 0}});
  EXPECT_NEAR(estimate.mean().mean(), 2, sure * error_of(estimate));
}

TEST(PathTracer, APaneDimsAnEmitterBehindIt) {
  for (const bool two_sided : {false, true})
    for (const bool faces_down : {false, true}) {
      Scene scene;
      scene.materials = {grey(3, 0)};
      add_ceiling(scene, 1, 1, 0);
      add_black_floor(scene, 1);
      const SurfacePoint point{{0, 0, 0}, {0, 0, 1}};
      const double clear = traced(scene, point).mean().r;
      scene.materials.push_back({"pane", {}, {}, two_sided, {0.8, 0.5, 0.2}});
      if (faces_down) add_ceiling(scene, 4, 0.5, 2);
      else add_polygon(scene, {{-2, -2, 0.5}, {2, -2, 0.5}, {2, 2, 0.5}, {-2, 2, 0.5}}, 2);
      const auto estimate = traced(scene, point);
      const double noise = sure * error_of(estimate) + 0.01 * clear;
      EXPECT_NEAR(estimate.mean().r, 0.8 * clear, noise);
      EXPECT_NEAR(estimate.mean().g, 0.5 * clear, noise);
      EXPECT_NEAR(estimate.mean().b, 0.2 * clear, noise);
    }
}

TEST(PathTracer, SquareEmitterGivesItsFormFactor) {
  Scene scene;
  scene.materials = {grey(3, 0)};
  add_ceiling(scene, 1, 1, 0);
  add_black_floor(scene, 1);
  for (const auto& [x, form_factor] : {std::pair{0.0, 4 * corner_form_factor(0.5, 0.5)}, {0.5, 2 * corner_form_factor(1, 0.5)}}) {
    const auto estimate = traced(scene, {{x, 0, 0}, {0, 0, 1}});
    EXPECT_NEAR(estimate.mean().mean(), 3 * form_factor, sure * error_of(estimate));
    EXPECT_LT(error_of(estimate), 0.005 * 3 * form_factor);  // because no sample exceeds the emission
  }
}

TEST(PathTracer, AMediumDimsByDistance) {
  constexpr double side = 0.05, distance = 5;
  Scene scene;
  scene.materials = {grey(1, 0)};
  scene.absorption = {0, 0.1, 1};
  add_ceiling(scene, side, distance, 0);
  add_black_floor(scene, 1);
  const auto estimate = traced(scene, {{0, 0, 0}, {0, 0, 1}});
  const double clear = side * side / (std::numbers::pi * distance * distance);  // the square is small: accurate to 1e-4
  EXPECT_NEAR(estimate.mean().r, clear, 3e-4 * clear);
  EXPECT_NEAR(estimate.mean().g, clear * std::exp(-0.5), 3e-4 * clear);
  EXPECT_NEAR(estimate.mean().b, clear * std::exp(-5), 3e-4 * clear);
}

TEST(PathTracer, AMediumDimsReflectedLightOnBothLegs) {
  // Lamp and point lie side by side and look up at a small white square.
  Scene scene;
  scene.materials = {grey(100, 0), grey(0, 0.8)};
  scene.absorption = {0, 0.1, 0.2};
  const double h = 0.05;
  add_polygon(scene, {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, 0);
  add_ceiling(scene, 0.5, 5, 1);
  const auto estimate = traced(scene, {{0.2, 0, 0}, {0, 0, 1}}, 1 << 15);
  const double clear = estimate.mean().r;
  EXPECT_GT(clear, 0);
  EXPECT_NEAR(estimate.mean().g / clear, std::exp(-1), 0.003);  // path segments are 5 to 5.02 m long
  EXPECT_NEAR(estimate.mean().b / clear, std::exp(-2), 0.003);
}

TEST(PathTracer, BacksAreBlackAndBlockUnlessTwoSided) {
  const SurfacePoint below{{0, 0, 0}, {0, 0, 1}};
  for (const bool two_sided : {false, true}) {
    Scene scene;
    scene.materials = {grey(1, 0)};
    scene.materials[0].two_sided = two_sided;
    add_polygon(scene, {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}});  // faces up
    add_black_floor(scene, 1);
    const auto estimate = traced(scene, below);
    EXPECT_NEAR(estimate.mean().mean(), two_sided ? 4 * corner_form_factor(1, 1) : 0, sure * error_of(estimate) + 1e-12);
  }
  Scene shaded;
  shaded.materials = {grey(1, 0), grey(0, 0.5)};
  add_ceiling(shaded, 1, 2, 0);
  add_polygon(shaded, {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}, 1);
  add_black_floor(shaded, 1);
  EXPECT_TRUE(traced(shaded, below).mean().is_zero());
}

TEST(PathTracer, UnderASolidIsEnclosed) {
  const Scene scene = test::coloured_room();  // a block stands at x 1 to 2, z 1 to 3
  const PathTracer tracer(scene);
  EXPECT_TRUE(tracer.is_enclosed({{1.5, 0, 2}, {0, 1, 0}}, 64, PathRandom(1, 0, 0)));
  EXPECT_FALSE(tracer.is_enclosed({{3, 0, 2}, {0, 1, 0}}, 64, PathRandom(1, 0, 0)));
}

TEST(PathTracer, KnowsNeitherUnitsNorOrigin) {
  Scene scene = test::coloured_room();
  scene.absorption = {0.1, 0.2, 0.3};
  const SurfacePoint point{{0, 1, 2.5}, {1, 0, 0}};
  const auto here = traced(scene, point);
  const double scale = 1e-3;
  const Vec3 away{1000, -500, 0};
  Scene there = scene;
  for (Vec3& vertex : there.vertices) vertex = scale * vertex + away;
  there.absorption *= 1 / scale;
  const auto moved = traced(there, {scale * point.position + away, point.normal});
  const double error = std::hypot(error_of(here), error_of(moved));
  EXPECT_NEAR(moved.mean().mean(), here.mean().mean(), sure * error);
}

/// Returns the numbers of a line; none if it does not begin with a number.
std::vector<double> numbers_of(const std::string& line) {
  std::istringstream cells(line);
  std::vector<double> numbers;
  for (double number; cells >> number; cells.ignore()) numbers.push_back(number);
  return numbers;
}

TEST(PathTracer, AgreesWithStoredTruthWithinBothErrors) {
  const Scene scene = read_scene_file(ALVOR_TEST_FILES "/truth/cornell_box.obj").scene;
  std::ifstream file(ALVOR_TEST_FILES "/truth/cornell_box.irradiance.csv");
  std::vector<SurfacePoint> points;
  std::vector<std::vector<double>> truth;
  for (std::string line; std::getline(file, line);)
    if (const auto row = numbers_of(line); row.size() == 12) {
      truth.push_back(row);
      points.push_back({{row[0], row[1], row[2]}, normalized({row[3], row[4], row[5]})});
    }
  ASSERT_EQ(points.size(), 300u);
  const auto estimates = trace_irradiance(PathTracer(scene), points, {.paths = 4000});
  double squares = 0, sum = 0, weight = 0;
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double variance = estimates[n].variance().g + truth[n][10] * truth[n][10];
    const double difference = estimates[n].mean().g - truth[n][7];
    squares += difference * difference / variance;
    sum += difference / variance, weight += 1 / variance;
  }
  // Squares of Student's t with 62 degrees of freedom have mean 1.03; the mean over 300 has a standard deviation of 0.09.
  EXPECT_NEAR(squares / 300, 1.03, 0.35);
  EXPECT_LT(std::abs(sum / std::sqrt(weight)), sure);  // all points together
}

TEST(PathTracer, ResultsDependOnSeedAndPathsOnly) {
  const Scene scene = test::coloured_room();
  const PathTracer tracer(scene);
  const auto points = draw_surface_points(scene, 50, 3);
  const auto one = trace_irradiance(tracer, points, {.paths = 100, .seed = 5, .threads = 1});
  const auto two = trace_irradiance(tracer, points, {.paths = 100, .seed = 5, .threads = 2});
  const auto other = trace_irradiance(tracer, points, {.paths = 100, .seed = 6, .threads = 1});
  for (std::size_t n = 0; n < points.size(); ++n) EXPECT_EQ(one[n].mean(), two[n].mean());
  EXPECT_NE(one[0].mean(), other[0].mean());
}

TEST(PathTracer, TimeLimitLeavesAllPointsTheSameRounds) {
  const Scene scene = test::coloured_room();
  const auto points = draw_surface_points(scene, 20, 3);
  const auto estimates = trace_irradiance(PathTracer(scene), points, {.paths = 1'000'000'000, .time_limit_s = 0.02});
  for (const auto& estimate : estimates) EXPECT_EQ(estimate.rounds(), estimates.front().rounds());
  EXPECT_GE(estimates.front().rounds(), 2u);
}

TEST(RoundPlan, HasManyRoundsOfAPowerOfTwo) {
  EXPECT_EQ(RoundPlan(2).rounds, 2u);
  EXPECT_EQ(RoundPlan(1000).paths_per_round, 32u);
  EXPECT_EQ(RoundPlan(1000).rounds, 32u);
  EXPECT_EQ(RoundPlan(1 << 20).paths_per_round, 64u);
}

TEST(SurfacePoints, AreUniformByAreaOverFrontsAndBothSidesOfTwoSided) {
  Scene scene;
  scene.materials = {grey(0, 0.5), grey(0, 0.5)};
  scene.materials[1].two_sided = true;
  add_polygon(scene, {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}}, 0);  // 2 m2
  add_polygon(scene, {{0, 0, 1}, {1, 0, 1}, {0, 2, 1}}, 1);             // 2 x 1 m2
  constexpr int count = 40000;
  std::array<int, 3> seen{};  // one-sided; front and back of two-sided
  double mean_x = 0;
  for (const SurfacePoint& point : draw_surface_points(scene, count, 1)) {
    ++seen[point.face == 0 ? 0 : point.normal.z > 0 ? 1 : 2];
    if (point.face == 0) mean_x += point.position.x;
  }
  const double spread = sure * std::sqrt(count * 0.25);
  EXPECT_NEAR(seen[0], count / 2.0, spread);
  EXPECT_NEAR(seen[1], count / 4.0, spread);
  EXPECT_NEAR(seen[2], count / 4.0, spread);
  EXPECT_NEAR(mean_x / seen[0], 1, sure * std::sqrt(1.0 / 3 / seen[0]));
}

/// Returns small lamps on a ceiling, every other one facing up.
EmitterTree lamps(int count) {
  std::vector<EmittingTriangle> lights;
  for (int n = 0; n < count; ++n) {
    EmittingTriangle light{{n % 10 * 1.0, n / 10 * 1.0, 3}, {0, 0.1, 0}, {0.1, 0, 0}, {0, 0, -1}, 0.005, {1.0 + n, 1, 1}, false};
    if (n % 2) std::swap(light.side_u, light.side_v), light.normal = {0, 0, 1};
    lights.push_back(light);
  }
  return EmitterTree(std::move(lights));
}

TEST(EmitterTree, ChoosesWithTheProbabilitiesItSays) {
  constexpr int count = 100, draws = 100000;
  const EmitterTree tree = lamps(count);
  const Vec3 point{2, 3, 0}, normal = normalized({0.3, 0, 1});
  std::vector<int> chosen(count);
  double left = 0;
  int found = 0;
  for (int n = 0; n < draws; ++n) {
    const auto choice = tree.choose(point, normal, (n + 0.5) / draws);
    if (!choice) continue;
    ++found, ++chosen[choice->light], left += choice->rest;
    ASSERT_DOUBLE_EQ(choice->probability, tree.probability(point, normal, choice->light));
  }
  EXPECT_NEAR(left / found, 0.5, 1e-3);
  for (std::uint32_t light = 0; light < count; ++light) {
    EXPECT_NEAR(chosen[light], draws * tree.probability(point, normal, light), 1.5) << light;
    EXPECT_EQ(chosen[light] > 0, light % 2 == 0) << light;  // the others face up
  }
}

TEST(EmitterTree, ManyLampsGiveWhatTheyGiveOneByOne) {
  Scene scene;
  scene.materials = {grey(10, 0)};
  double expected = 0;
  for (int n = 0; n < 400; ++n) {
    const double x = n % 20 - 9.5, y = n / 20 - 9.5, h = 0.05;
    add_polygon(scene, {{x - h, y - h, 1}, {x - h, y + h, 1}, {x + h, y + h, 1}, {x + h, y - h, 1}});
    const double square = x * x + y * y + 1;
    expected += 10 * 0.01 / (std::numbers::pi * square * square);
  }
  add_black_floor(scene, 1);
  const auto estimate = traced(scene, {{0, 0, 0}, {0, 0, 1}});
  EXPECT_NEAR(estimate.mean().mean(), expected, sure * error_of(estimate) + 5e-3 * expected);  // lamps are not points
  EXPECT_LT(error_of(estimate), 0.02 * expected);
}

// With linear filters a texture of two columns goes evenly from one to the other between their middles.
TEST(PathTracer, FollowsTexturesThatChangeOverAFace) {
  Scene scene;
  scene.materials = {grey(0, 0), test::textured({2, 1, {60, 60, 60, 240, 240, 240}}, {1, 1, 1}, Wrap::clamp)};
  scene.materials[1].emission = {};
  Light sun{"sun", LightKind::directional, {10, 10, 10}};
  sun.direction = {0, 0, 1};
  scene.lights = {sun};
  // A wide face that looks down to the point, lit from below, with the first texel's middle at x = -2 and the second's at 2.
  test::add_textured(scene, {{-4, -4, 1}, {-4, 4, 1}, {4, 4, 1}, {4, -4, 1}}, {{0, 0}, {0, 1}, {1, 1}, {1, 0}}, 1);
  test::add_polygon(scene, {{-0.01, -0.01, 0}, {0.01, -0.01, 0}, {0.01, 0.01, 0}, {-0.01, 0.01, 0}});
  const double dark = reflectance_of_texel(60), light = reflectance_of_texel(240);
  // By the integral of B(x) cos cos / (pi r^2) over the face.
  double expected = 0;
  constexpr int steps = 2000;
  for (int i = 0; i < steps; ++i)
    for (int j = 0; j < steps; ++j) {
      const double x = -4 + 8 * (i + 0.5) / steps, y = -4 + 8 * (j + 0.5) / steps, square = x * x + y * y + 1;
      const double rho = dark + (light - dark) * std::clamp((x + 2) / 4, 0.0, 1.0);
      expected += 10 * rho / (std::numbers::pi * square * square) * 64.0 / (steps * steps);
    }
  const auto estimate = traced(scene, {{0, 0, 0}, {0, 0, 1}}, 1 << 16);
  EXPECT_NEAR(estimate.mean().mean(), expected, sure * error_of(estimate) + 1e-3 * expected);
  EXPECT_LT(error_of(estimate), 0.01 * expected);
}

}  // namespace
}  // namespace alvor
