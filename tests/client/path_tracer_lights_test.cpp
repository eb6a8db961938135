// Tests of path tracing to lamps and environment maps.

#include "client/verify/surface_points.h"
#include "radiosity/solve/solver.h"
#include "tests/client/path_tracing.h"
#include "tests/environments.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using test::add_polygon;
using test::grey;

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
  const auto traced = trace_irradiance(PathTracer(scene), points, {.paths = 1024, .threads = 2});
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

}  // namespace
}  // namespace alvor
