// Tests of path tracing against closed forms and against independent Monte Carlo results.

#include "client/verify/irradiance_estimate.h"
#include "client/verify/surface_points.h"
#include "import/apart/scene_file.h"
#include "radiosity/solve/solver.h"
#include "tests/environments.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

namespace alvor {
namespace {

using test::add_polygon;
using test::grey;

constexpr double sure = 4;  ///< standard errors: exceeded once in 16 000 cases, and the seed is fixed

IrradianceEstimate traced(const Scene& scene, const SurfacePoint& point, std::uint64_t paths = 4096) {
  return trace_irradiance(PathTracer(scene), std::span(&point, 1), {.paths = paths, .threads = 1}).front();
}

double error_of(const IrradianceEstimate& estimate) { return std::sqrt(estimate.variance_of_band_mean()); }

/// Adds a black floor about the z axis at height 0.
void add_black_floor(Scene& scene, double side) {
  const double h = side / 2;
  const auto black = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(grey(0, 0));
  add_polygon(scene, {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}}, black);
}

/// Adds a square of this side about the z axis at height z, facing down.
void add_ceiling(Scene& scene, double side, double z, std::uint32_t material) {
  const double h = side / 2;
  add_polygon(scene, {{-h, -h, z}, {-h, h, z}, {h, h, z}, {h, -h, z}}, material);
}

/// Returns the form factor from a point to a parallel rectangle of sides a, b at distance 1, whose corner is above the point.
double corner_form_factor(double a, double b) {
  const double ra = std::sqrt(1 + a * a), rb = std::sqrt(1 + b * b);
  return (a / ra * std::atan(b / ra) + b / rb * std::atan(a / rb)) / (2 * std::numbers::pi);
}

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

TEST(PathTracer, AConstantEnvironmentBringsPiTimesItsRadiance) {
  Scene scene;
  add_black_floor(scene, 2);
  scene.lights = {test::environment({16, 8}, [](Vec3) { return Rgb{2, 2, 2}; })};
  const auto estimate = traced(scene, {{0.3, 0.2, 0}, {0, 0, 1}});
  EXPECT_NEAR(estimate.mean().g, 2 * std::numbers::pi, sure * error_of(estimate) + 1e-3);
  EXPECT_LT(error_of(estimate), 0.01 * estimate.mean().g);
}

// A small bright part is found by its own light: cosine-distributed directions alone would have an error of 40 %.
TEST(PathTracer, ASmallBrightPartOfAnEnvironmentIsSampledByItsLight) {
  Scene scene;
  add_black_floor(scene, 2);
  const Vec3 towards = normalized(Vec3{0.6, 0.3, 0.7});
  const Light light = test::environment({256, 128}, [&](Vec3 d) {
    return (dot(d, towards) > 0.9994 ? 1e4 : 0.01) * Rgb{1, 1, 1};
  });
  scene.lights = {light};
  double exact = 0;
  const EnvironmentMap& map = *light.environment;
  for (std::uint32_t row = 0; row < 128; ++row)
    for (std::uint32_t column = 0; column < 256; ++column)
      exact += double{map.pixels[row * 256 + column].g} *
               std::max(0.0, EnvironmentAxes(light).to_scene(map.grid.direction_sum(row, column)).z);
  const auto estimate = traced(scene, {{0.3, 0.2, 0}, {0, 0, 1}});
  EXPECT_NEAR(estimate.mean().g, exact, sure * error_of(estimate) + 0.002 * exact);
  EXPECT_LT(error_of(estimate), 0.02 * exact);
}

/// Returns a room of 4 x 3 x 5 m whose wall z = 0 is open above 0.8 m.
Scene room_with_window() {
  Scene scene;
  scene.materials = {grey(0, 0.5)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true);
  std::erase_if(scene.faces, [&](const Face& face) {
    return std::ranges::all_of(scene.corners_of(face), [&](std::uint32_t v) { return scene.vertices[v].z == 0; });
  });
  add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 0.8, 0}, {0, 0.8, 0}});
  return scene;
}

TEST(PathTracer, AgreesWithTheSolverInARoomWithAWindowUnderAColouredEnvironment) {
  Scene scene = room_with_window();
  scene.lights = {test::environment({128, 64}, [](Vec3 d) {
    const double bright = 20 * std::exp(60 * (dot(d, normalized(Vec3{0.4, 0.5, -0.8})) - 1));
    return d.y > 0 ? Rgb{1 + bright, 1.5 + bright, 3 + 0.7 * bright} : Rgb{0.4, 0.5, 0.2};
  })};
  const BaseMesh mesh(scene);
  SolutionLog log;
  solve(mesh, {.tolerance = 0.03}, log, {});
  std::vector<SurfacePoint> points;
  Rgb solved;
  double weight = 0;
  std::vector<double> weights;
  for (const LeafValue& leaf : log.leaves()) {
    const PatchShape shape = shape_of(mesh, leaf.patch);
    const double area = area_of(mesh, shape);
    points.push_back({centre_of(mesh, shape), mesh.roots()[shape.root].normal});
    weights.push_back(area);
    solved += area * widen(leaf.irradiance);
    weight += area;
  }
  const auto traced = trace_irradiance(PathTracer(scene), points, {.paths = 512, .threads = 2});
  Rgb expected;
  double variance = 0;
  for (std::size_t n = 0; n < traced.size(); ++n) {
    expected += weights[n] * traced[n].mean();
    variance += weights[n] * weights[n] * traced[n].variance_of_band_mean();
  }
  const double error = sure * std::sqrt(variance) / weight;
  EXPECT_LT(error, 0.01 * expected.mean() / weight);
  for (const double ratio : {solved.r / expected.r, solved.g / expected.g, solved.b / expected.b})
    EXPECT_NEAR(ratio, 1, 0.01 + error * weight / expected.mean());
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

Light lamp_at(Vec3 place, LightKind kind, double intensity) {
  Light lamp;
  lamp.kind = kind;
  lamp.intensity = {intensity, intensity, intensity};
  lamp.position = place;
  return lamp;
}

TEST(PathTracer, LampsBringWhatTheirFormulasSay) {
  Scene scene;
  add_black_floor(scene, 10);
  const SurfacePoint point{{0, 0, 0}, {0, 0, 1}};
  const auto expect = [&](const Light& lamp, double irradiance, double tolerance) {
    scene.lights = {lamp};
    EXPECT_NEAR(traced(scene, point).mean().mean(), irradiance, tolerance * irradiance) << static_cast<int>(lamp.kind);
  };
  constexpr double above = 2e-5;  // rays start 1e-6 of the extent above their surface
  const Vec3 way{1, 1, 2};
  expect(lamp_at(way, LightKind::point, 100), 100 * 2 / std::pow(6, 1.5), above);
  Light sphere = lamp_at(way, LightKind::point, 100);
  sphere.radius = 0.5;
  expect(sphere, 100 * 2 / std::pow(6, 1.5), 1e-3);
  Light spot = lamp_at(way, LightKind::spot, 100);
  spot.direction = -1 / length(way) * way;
  expect(spot, 100 * 2 / std::pow(6, 1.5), above);
  Light sun = lamp_at({}, LightKind::directional, 100);
  sun.direction = {0.6, 0, -0.8};
  expect(sun, 80, 1e-9);
  sun.angular_diameter = 0.2;
  expect(sun, 80, 5e-3);
}

// A luminaire with a Lambertian web brings what an emissive face in the place of its opening brings, also close by.
TEST(PathTracer, ALambertianLuminaireIsAnAreaLamp) {
  auto web = std::make_shared<PhotometricWeb>(PhotometricWeb{.planes = {0}});
  for (int degree = 0; degree <= 90; ++degree) {
    web->angles.push_back(degree);
    web->intensities.push_back(static_cast<float>(100 * std::cos(degree * std::numbers::pi / 180)));
  }
  Light panel = lamp_at({0, 0, 1}, LightKind::luminaire, 1);
  panel.across = {1, 0, 0};
  panel.opening = {LuminousOpening::Shape::rectangle, 1.2, 0.8, 0};
  panel.web = web;
  Scene by_web, by_face;
  add_black_floor(by_web, 10);
  by_web.lights = {panel};
  add_black_floor(by_face, 10);
  by_face.materials.push_back(grey(std::numbers::pi * 100 / (1.2 * 0.8), 0));
  const auto material = static_cast<std::uint32_t>(by_face.materials.size() - 1);
  by_face.add_polygon(std::vector<Vec3>{{-0.6, -0.4, 1}, {-0.6, 0.4, 1}, {0.6, 0.4, 1}, {0.6, -0.4, 1}}, material);
  for (const Vec3 place : {Vec3{0, 0, 0}, {0.5, 0.7, 0}, {2, 1, 0}}) {
    const auto a = traced(by_web, {place, {0, 0, 1}}), b = traced(by_face, {place, {0, 0, 1}});
    EXPECT_NEAR(a.mean().mean(), b.mean().mean(), sure * (error_of(a) + error_of(b)) + 1e-4 * b.mean().mean()) << place.x;
  }
}

TEST(PathTracer, AllLampsTogetherBringTheirSum) {
  Scene scene;
  add_black_floor(scene, 10);
  scene.lights = {lamp_at({0, 0, 2}, LightKind::point, 10), lamp_at({0, 0, 3}, LightKind::point, 90),
                  lamp_at({0, 0, -1}, LightKind::point, 50)};
  const auto estimate = traced(scene, {{0, 0, 0}, {0, 0, 1}});
  EXPECT_NEAR(estimate.mean().mean(), 10 / 4.0 + 90 / 9.0, sure * error_of(estimate) + 2e-4);
}

TEST(PathTracer, ALampInACubeHasTheKnownMeanIlluminance) {
  // CIE 171:2006, test 5.8: Phi / (S (1 - rho)); here over the mean of points of one wall, which all walls equal.
  Scene scene;
  scene.materials = {grey(0, 0.8)};
  test::add_box(scene, {0, 0, 0}, {4, 4, 4}, true);
  scene.lights = {lamp_at({2, 2, 2}, LightKind::point, 1000)};
  std::vector<SurfacePoint> points;
  constexpr int n = 16;
  for (int k = 0; k < n * n; ++k) points.push_back({{(k % n + 0.5) * 4 / n, 0, (k / n + 0.5) * 4 / n}, {0, 1, 0}});
  double mean = 0, variance = 0;
  for (const auto& estimate : trace_irradiance(PathTracer(scene), points, {.paths = 1024})) {
    mean += estimate.mean().mean() / (n * n);
    variance += estimate.variance_of_band_mean() / (n * n * n * n);
  }
  const double expected = 4 * std::numbers::pi * 1000 / (96 * 0.2);
  EXPECT_NEAR(mean, expected, sure * std::sqrt(variance) + 1e-3 * expected);
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

}  // namespace
}  // namespace alvor
