// Skies and the sun, against closed forms and integrals by another rule.

#include "meshing/sun_position.h"
#include "radiosity/direct/lights_of_scene.h"
#include "radiosity/form_factors/form_factor.h"
#include "radiosity/plan/plan.h"
#include "tests/radiosity/solve_scenes.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using std::numbers::pi;

Light sky_light(const SkyDistribution& sky, double irradiance = 1000) {
  Light light;
  light.name = "sky";
  light.kind = LightKind::sky;
  light.intensity = {irradiance, irradiance, irradiance};
  light.direction = {0, -1, 0};
  light.sky = sky;
  return light;
}

Vec3 direction_at(double elevation_degrees, double azimuth_degrees) {
  const double h = elevation_degrees * pi / 180, a = azimuth_degrees * pi / 180;
  return {std::cos(h) * std::sin(a), std::sin(h), -std::cos(h) * std::cos(a)};
}

/// Returns the irradiance of a plane by Simpson's rule in elevation and azimuth: another rule than the one that normalises skies.
double irradiance(const SkyDome& dome, Vec3 normal) {
  constexpr int n = 600, m = 400;
  double sum = 0;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j < m; ++j) {
      const double h = pi / 2 * i / n, a = 2 * pi * j / m, weight = i == 0 || i == n ? 1 : i % 2 == 1 ? 4 : 2;
      const Vec3 direction{std::cos(h) * std::cos(a), std::sin(h), std::cos(h) * std::sin(a)};
      sum += weight * dome.radiance(direction) * std::max(0.0, dot(direction, normal)) * std::cos(h);
    }
  return sum * (pi / 2 / n / 3) * (2 * pi / m);
}

TEST(Sky, OfEveryCieKindHasTheIrradianceThatWasAskedFor) {
  for (int number = 1; number <= 15; ++number)
    for (const double elevation : {15.0, 45.0, 80.0}) {
      const SkyDome dome(sky_light(cie_sky(number, direction_at(elevation, 30))));
      EXPECT_NEAR(irradiance(dome, {0, 1, 0}), 1, 2e-4) << "CIE " << number << ", sun at " << elevation;
    }
}

// ISO 15469:2004: relative to the zenith a sky is phi(Z) f(chi) / (phi(0) f(Zs)).
TEST(Sky, OfCieKind12HasItsKnownRatios) {
  const double sun_zenith = 40 * pi / 180;
  const SkyDome dome(sky_light(cie_sky(12, direction_at(50, 0))));
  const auto phi = [](double z) { return 1 - std::exp(-0.32 / std::cos(z)); };
  const auto f = [](double chi) {
    return 1 + 10 * (std::exp(-3 * chi) - std::exp(-3 * pi / 2)) + 0.45 * std::pow(std::cos(chi), 2);
  };
  const double zenith = dome.radiance({0, 1, 0});
  for (const double z : {20.0, 60.0, 80.0}) {  // in the sun's vertical, on its side
    const double angle = z * pi / 180, expected = phi(angle) * f(std::abs(angle - sun_zenith)) / (phi(0) * f(sun_zenith));
    EXPECT_NEAR(dome.radiance(direction_at(90 - z, 0)) / zenith, expected, 1e-9 * expected) << z;
  }
}

TEST(Sky, OvercastIsThreeTimesAsBrightInTheZenithAsAtTheHorizon) {
  const SkyDome dome(sky_light({.g = 2}));
  EXPECT_NEAR(dome.radiance({0, 1, 0}), 9 / (7 * pi), 1e-4);
  EXPECT_NEAR(dome.radiance(direction_at(0.6, 0)) / dome.radiance({0, 1, 0}), 1 / 3.0, 0.01);
  EXPECT_EQ(dome.radiance(direction_at(-1, 0)), 0);
  EXPECT_NEAR(SkyDome(sky_light({})).radiance(direction_at(10, 3)), 1 / pi, 1e-6);
}

TEST(Sky, OfPerezIsBrighterAboutTheSunAndSoundForAllWeather) {
  for (const double elevation : {5.0, 30.0, 85.0})
    for (const double direct : {0.0, 50.0, 400.0, 950.0})
      for (const double diffuse : {30.0, 100.0, 350.0}) {
        const double zenith = (90 - elevation) * pi / 180;
        const SkyDistribution sky = perez_sky(direct, diffuse, zenith, direction_at(elevation, 0));
        ASSERT_EQ(fault_in(sky), std::nullopt);
        const SkyDome dome(sky_light(sky));
        EXPECT_NEAR(irradiance(dome, {0, 1, 0}), 1, 5e-3) << elevation << ' ' << direct << ' ' << diffuse;
        if (direct > 300 && elevation == 30) {
          EXPECT_GT(dome.radiance(direction_at(30, 0)), 3 * dome.radiance(direction_at(30, 180)));
        }
      }
}

// Perez et al. (1993): (1 + a exp(b / cos Z)) (1 + c exp(d chi) + e cos2 chi). Their table gives, for clearness 1 (no direct
// light), brightness 0.2 and the sun at z = 1 radian from the zenith, these coefficients.
TEST(Sky, OfPerezHasTheRatiosOfItsFormula) {
  const double z = 1, brightness = 0.2;
  const auto fit = [&](double x1, double x2, double x3, double x4) { return x1 + x2 * z + brightness * (x3 + x4 * z); };
  const double a = fit(1.3525, -0.2576, -0.2690, -1.4366), b = fit(-0.7670, 0.0007, 1.2734, -0.1233);
  const double c = std::exp(std::pow(brightness * (2.8 + 0.6004 * z), 1.2375)) - 1;
  const double d = -std::exp(brightness * (1.8734 + 0.6297 * z)) + 0.9738 + brightness * 0.2809;
  const double e = fit(0.0356, -0.1246, -0.5718, 0.9938);
  const double elevation = 90 - z * 180 / pi, air_mass = 1 / (std::cos(z) + 0.15 * std::pow(93.885 - z * 180 / pi, -1.253));
  const SkyDome dome(sky_light(perez_sky(0, brightness * 1367 / air_mass, z, direction_at(elevation, 0))));
  const auto expected = [&](Vec3 direction) {
    const double chi = std::acos(dot(direction, direction_at(elevation, 0)));
    return (1 + a * std::exp(b / direction.y)) * (1 + c * std::exp(d * chi) + e * std::cos(chi) * std::cos(chi));
  };
  const Vec3 zenith{0, 1, 0};
  for (const Vec3 direction : {direction_at(30, 0), direction_at(30, 180), direction_at(60, 90), direction_at(10, 120)}) {
    const double ratio = expected(direction) / expected(zenith);
    EXPECT_NEAR(dome.radiance(direction) / dome.radiance(zenith), ratio, 1e-6 * ratio);
  }
}

/// Returns the light of the sky that reaches a root, in multiples of its intensity.
class OnOpenGround : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(CieSkies, OnOpenGround, testing::Values(1, 5, 12), testing::PrintToStringParamName());

TEST_P(OnOpenGround, TiltedFacesGetTheIntegralOverWhatTheySee) {
  const Light sky = sky_light(cie_sky(GetParam(), direction_at(40, 60)));
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_polygon(scene, {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
  scene.lights = {sky};
  const BaseMesh mesh(scene);
  const LocalScene local(mesh);
  const auto lights = lights_beside_faces(local, EmissionUnit(mesh));
  ASSERT_EQ(lights.size(), 1u);
  const SkyDome dome(sky);
  for (const Vec3 normal : {Vec3{0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0.6, 0.8, 0}, {0.48, -0.6, 0.64}, {0, -1, 0}}) {
    const double expected = irradiance(dome, normal);
    EXPECT_NEAR(lights[0]->unblocked({}, normal), expected, 4e-3 * expected + 1e-3) << normal.x << ' ' << normal.y;
  }
}

/// Returns a black room of 4 x 3 x 4 m whose ceiling (`is_roof`) or wall z = 0 has a hole of 2 x 1.5 m in its middle.
Scene room_with_hole(bool is_roof, std::vector<Vec3>& hole) {
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  // The side with the hole is made of four faces.
  const auto at = [&](double u, double v) { return is_roof ? Vec3{4 * u, 3, 4 * v} : Vec3{4 * u, 3 * v, 0}; };
  std::erase_if(scene.faces, [&](const Face& face) {
    return std::ranges::all_of(scene.corners_of(face),
                               [&](std::uint32_t v) { return is_roof ? scene.vertices[v].y == 3 : scene.vertices[v].z == 0; });
  });
  const auto add = [&](double u0, double v0, double u1, double v1) {
    test::add_polygon(scene, {at(u0, v0), at(u1, v0), at(u1, v1), at(u0, v1)});
  };
  add(0, 0, 1, 0.25), add(0, 0.75, 1, 1), add(0, 0.25, 0.25, 0.75), add(0.75, 0.25, 1, 0.75);
  hole = {at(0.25, 0.25), at(0.75, 0.25), at(0.75, 0.75), at(0.25, 0.75)};
  return scene;
}

/// Returns the irradiance that a uniform sky of 1000 brings through a hole to a place, by the form factor of the hole. All of the
/// hole lies above the horizon of the sky and of the place.
double brought_through(std::vector<Vec3> hole, Vec3 at, Vec3 normal) {
  if (std::abs(point_to_polygon(at, normal, hole)) < 1e-9) std::ranges::reverse(hole);  // it was seen from behind
  return 1000 * std::abs(point_to_polygon(at, normal, hole));
}

// Uniform sky of irradiance E: a point below a hole gets E times the form factor to the hole; beside a window it gets E times the
// form factor to the part of the window above its horizon.
TEST(SkyThroughAHole, BringsTheSkyComponentOfAUniformSky) {
  for (const bool is_roof : {true, false}) {
    std::vector<Vec3> hole;
    Scene scene = room_with_hole(is_roof, hole);
    scene.lights = {sky_light({})};
    const BaseMesh mesh(scene);
    std::size_t compared = 0;
    double error = 0, mean = 0;
    for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 1e-4, .max_depth = 5})) {
      const PatchShape shape = shape_of(mesh, leaf.patch);
      const RootPatch& root = mesh.roots()[shape.root];
      if (root.normal.y < 0.9) continue;  // the floor: all of the hole is above its horizon
      const double expected = brought_through(hole, centre_of(mesh, shape), root.normal);
      error += std::abs(leaf.irradiance.g - expected), mean += expected;
      ++compared;
    }
    EXPECT_GT(compared, 500u);
    EXPECT_LT(error / mean, 0.01) << is_roof;
  }
}

// The walls here stand so that the plane of a wall crosses the window: a point of such a wall sees only the part of the window
// before its plane. One side of that part lies on the horizon, where the sky ends.
TEST(SkyThroughAHole, WallsSeeThePartOfAWindowAboveTheirHorizon) {
  std::vector<Vec3> hole;
  Scene scene = room_with_hole(false, hole);
  scene.lights = {sky_light({})};
  const BaseMesh mesh(scene);
  std::size_t compared = 0;
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 1e-4, .max_depth = 5})) {
    const PatchShape shape = shape_of(mesh, leaf.patch);
    const RootPatch& root = mesh.roots()[shape.root];
    const Vec3 centre = centre_of(mesh, shape);
    if (root.normal.z > -0.9 || centre.y > 2) continue;  // the wall across from the window; near its upper edge it sees little
    std::vector<Vec3> seen = hole;
    for (Vec3& corner : seen) corner.y = std::max(corner.y, centre.y);
    const double expected = brought_through(seen, centre, root.normal);
    EXPECT_NEAR(leaf.irradiance.g, expected, 0.02 * expected) << centre.x << ' ' << centre.y;
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

// The reveals find the sky by rays, whose noise splitting does not remove: more rays do.
TEST(SkyThroughAHole, ADeepWindowIsSolvedToTheToleranceWithFewLeaves) {
  SolutionLog log;
  const BaseMesh mesh(test::room_under_overcast_sky());
  EXPECT_EQ(solve(mesh, {.tolerance = 0.03, .max_leaves = 50'000}, log, {}).reason, StopReason::tolerance);
  EXPECT_LT(log.last_step().leaves, 20'000u);
}

/// Solves a black room under a uniform sky of 1000 and returns the mean difference between the floor's irradiance and what the
/// sky would bring through the open holes, times `transmittance`, as a share of the mean.
double error_below_holes(Scene scene, const std::vector<std::vector<Vec3>>& holes, const Rgb& transmittance) {
  scene.lights = {sky_light({})};
  const BaseMesh mesh(scene);
  double error = 0, mean = 0;
  std::size_t compared = 0;
  // In a wide landscape an error of a few percent in the room is 1e-4 of the scene's mean.
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 1e-5, .max_depth = 5, .max_leaves = 20'000})) {
    const PatchShape shape = shape_of(mesh, leaf.patch);
    const RootPatch& root = mesh.roots()[shape.root];
    const Vec3 centre = centre_of(mesh, shape);
    if (root.normal.y < 0.9 || length(centre - Vec3{2, 0, 2}) > 3) continue;  // the floor
    double expected = 0;
    for (const std::vector<Vec3>& hole : holes) expected += brought_through(hole, centre, root.normal);
    error += std::abs(leaf.irradiance.r - transmittance.r * expected) + std::abs(leaf.irradiance.b - transmittance.b * expected);
    mean += expected;
    ++compared;
  }
  EXPECT_GT(compared, 50u);  // leaves are not split for noise, and there is little else
  return error / mean;
}

/// Adds a pane of two triangles, as files have them.
void add_pane(Scene& scene, const std::vector<Vec3>& corners, const Rgb& transmittance) {
  const auto number = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back({"pane", {}, {}, true, transmittance});
  test::add_polygon(scene, {corners[0], corners[1], corners[2]}, number);
  test::add_polygon(scene, {corners[0], corners[2], corners[3]}, number);
}

/// Adds black ground of 200 m about the room's place, far below it, so that the scene's bounding box is far away.
void add_landscape(Scene& scene) {
  test::add_polygon(scene, {{-100, -90, -100}, {-100, -90, 100}, {100, -90, 100}, {100, -90, -100}});
  test::add_polygon(scene, {{90, -90, 90}, {90, 90, 90}, {91, 90, 90}, {91, -90, 90}});
}

// A black room with one hole in its roof or wall, filled by a pane: the floor gets the light that the sky would send it through
// the open hole (its form factor times the sky's irradiance), times the pane's transmittance.
TEST(SkyThroughAPane, BringsTheSkyComponentTimesItsTransmittance) {
  for (const bool is_roof : {true, false}) {
    std::vector<Vec3> hole;
    Scene scene = room_with_hole(is_roof, hole);
    add_pane(scene, hole, {0.8, 0.6, 0.4});
    EXPECT_LT(error_below_holes(scene, {hole}, {0.8, 0.6, 0.4}), 0.015) << is_roof;
  }
}

TEST(SkyThroughAPane, IsAsExactInAWideLandscape) {
  for (const bool is_roof : {true, false}) {
    std::vector<Vec3> hole;
    Scene scene = room_with_hole(is_roof, hole);
    add_pane(scene, hole, {0.8, 0.6, 0.4});
    add_landscape(scene);
    EXPECT_LT(error_below_holes(scene, {hole}, {0.8, 0.6, 0.4}), 0.015) << is_roof;
  }
}

// A second, larger pane hangs 0.5 m outside of the window: light crosses both, and each direction counts once.
TEST(SkyThroughTwoPanes, CountsOnce) {
  std::vector<Vec3> hole;
  Scene scene = room_with_hole(false, hole);
  add_pane(scene, hole, {0.8, 0.6, 0.4});
  add_pane(scene, {{-4, -2, -0.5}, {8, -2, -0.5}, {8, 40, -0.5}, {-4, 40, -0.5}}, {0.5, 0.5, 0.5});
  add_landscape(scene);
  EXPECT_LT(error_below_holes(scene, {hole}, {0.4, 0.3, 0.2}), 0.02);
}

// The pane fills one half of the hole, and the other half is open: light comes past the pane from exits on the bounding box.
TEST(SkyBesideAPane, CountsOnce) {
  std::vector<Vec3> hole;
  Scene scene = room_with_hole(false, hole);
  const Vec3 low = 0.5 * (hole[0] + hole[1]), high = 0.5 * (hole[3] + hole[2]);
  add_pane(scene, {hole[0], low, high, hole[3]}, {1, 1, 1});
  EXPECT_LT(error_below_holes(scene, {hole}, {1, 1, 1}), 0.015);
  add_landscape(scene);
  EXPECT_LT(error_below_holes(scene, {hole}, {1, 1, 1}), 0.05);
}

// Overcast sky: the integral of radiance times cosine over the part of the window that a point of the floor sees.
TEST(SkyThroughAHole, BringsTheSkyComponentOfAnOvercastSky) {
  std::vector<Vec3> hole;
  Scene scene = room_with_hole(false, hole);
  const Light sky = sky_light({.g = 2});
  scene.lights = {sky};
  const BaseMesh mesh(scene);
  const SkyDome dome(sky);
  const auto expected_at = [&](Vec3 p) {
    constexpr int n = 60;
    double sum = 0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const Vec3 from = hole[0] + (i + 0.5) / n * (hole[1] - hole[0]) + (j + 0.5) / n * (hole[3] - hole[0]), way = from - p;
        const double squared = dot(way, way), distance = std::sqrt(squared);
        sum += dome.radiance(way / distance) * way.y * std::abs(way.z) / (squared * squared);
      }
    return 1000 * sum * 2 * 1.5 / (n * n);
  };
  double error = 0, mean = 0;
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 1e-4, .max_depth = 5})) {
    const PatchShape shape = shape_of(mesh, leaf.patch);
    if (mesh.roots()[shape.root].normal.y < 0.9) continue;
    const double expected = expected_at(centre_of(mesh, shape));
    error += std::abs(leaf.irradiance.g - expected), mean += expected;
  }
  EXPECT_LT(error / mean, 0.01);
}

TEST(SkyThroughAHole, IsNeededByThePlanAndASealedRoomStaysDark) {
  std::vector<Vec3> hole;
  Scene scene = room_with_hole(true, hole);
  scene.lights = {sky_light({})};
  EXPECT_TRUE(Plan(BaseMesh(scene), {}).may_be_lit(0));
  Scene sealed;
  sealed.materials = {test::grey(0, 0)};
  test::add_box(sealed, {0, 0, 0}, {4, 3, 4}, true);
  sealed.lights = {sky_light({})};
  EXPECT_FALSE(Plan(BaseMesh(sealed), {}).may_be_lit(0));
}

TEST(OpenGround, HasTheIrradianceOfTheSkyAndTheBalanceCountsIt) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_polygon(scene, {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
  scene.lights = {sky_light({.g = 2}, 10)};
  const BaseMesh mesh(scene);
  SolutionLog log;
  const SolveOutcome outcome = solve(mesh, {}, log, {});
  for (const LeafValue& leaf : log.leaves()) EXPECT_NEAR(leaf.irradiance.g, 10, 0.01);
  EXPECT_NEAR(outcome.balance.emitted, 3 * 10 * 64, 2);
}

// The example of Reda and Andreas (2004), table A5.1, without refraction: elevation 39.872046, azimuth 194.340241.
TEST(SunPosition, AgreesWithAKnownPlaceAndTime) {
  const SunPosition sun = sun_position({39.742476, -105.1786}, 1066419030);  // 2003-10-17 12:30:30, UTC - 7 h
  EXPECT_NEAR(sun.elevation, 39.872, 0.01);
  EXPECT_NEAR(sun.azimuth, 194.340, 0.01);
}

TEST(SunPosition, StandsHighestAtNoonAndInTheZenithBetweenTheTropics) {
  const double solstice = 1782043200;                                  // 2026-06-21 12:00 UTC
  EXPECT_NEAR(sun_position({23.44, 0}, solstice).elevation, 90, 0.6);  // 2 minutes before noon by the sun
  EXPECT_NEAR(sun_position({48, 0}, solstice).elevation, 90 - 48 + 23.44, 0.02);
  EXPECT_LT(sun_position({48, 180}, solstice).elevation, -10);
  EXPECT_EQ(clear_sky(-1).sun, 0);
  EXPECT_NEAR(clear_sky(90).sun, 127'500 * std::exp(-0.21), 1);
}

}  // namespace
}  // namespace alvor
