// Lamps and distant lights, against closed forms.

#include "radiosity/direct/direct_light.h"
#include "radiosity/direct/face_light.h"
#include "radiosity/direct/lights_of_scene.h"
#include "radiosity/plan/plan.h"
#include "radiosity/solve/solver.h"
#include "tests/radiosity/light_rays.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using std::numbers::pi;

Light point_lamp(Vec3 place, double intensity) {
  Light lamp;
  lamp.name = "bulb";
  lamp.intensity = {intensity, intensity, intensity};
  lamp.position = place;
  return lamp;
}

Light spot_lamp(Vec3 place, Vec3 direction, double inner, double outer) {
  Light lamp = point_lamp(place, 100);
  lamp.kind = LightKind::spot;
  lamp.direction = normalized(direction);
  lamp.inner_cone = inner, lamp.outer_cone = outer;
  return lamp;
}

Light sun(Vec3 direction, double irradiance, double angular_diameter = 0) {
  Light light = point_lamp({}, irradiance);
  light.kind = LightKind::directional;
  light.direction = normalized(direction);
  light.angular_diameter = angular_diameter;
  return light;
}

/// Returns a black floor of 8 x 8 m at height 0.
Scene floor_under(const Light& light) {
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_polygon(scene, {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
  scene.lights = {light};
  return scene;
}

/// Returns the mean irradiance over the area of all leaves, mean of the bands.
double mean_irradiance(const BaseMesh& mesh, const std::vector<LeafValue>& leaves) {
  double sum = 0, all = 0;
  for (const LeafValue& leaf : leaves) {
    const double area = area_of(mesh, shape_of(mesh, leaf.patch));
    sum += area * widen(leaf.irradiance).mean();
    all += area;
  }
  return sum / all;
}

/// Returns the mean of a function over 8 x 8 points of a parallelogram.
template <class Function>
double mean_over(const BaseMesh& mesh, const PatchShape& shape, Function&& function) {
  constexpr int points = 8;
  double sum = 0;
  for (int k = 0; k < points * points; ++k) {
    const double along_u = (k % points + 0.5) / points, along_v = (k / points + 0.5) / points;
    sum += function(mesh.roots()[shape.root].at((shape.first.i + shape.size_u * along_u) / grid_size,
                                                (shape.first.j + shape.size_v * along_v) / grid_size));
  }
  return sum / (points * points);
}

/// Compares the irradiance of each leaf of a fine mesh with the mean of what `expected` says for its points; NaN: not compared.
template <class Expected>
void expect_on_leaves(const Scene& scene, int depth, double tolerance, Expected&& expected) {
  const BaseMesh mesh(scene);
  std::size_t compared = 0;
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 1e-5, .max_depth = depth})) {
    const double there = mean_over(mesh, shape_of(mesh, leaf.patch), expected);
    if (std::isnan(there)) continue;
    EXPECT_NEAR(leaf.irradiance.g, there, tolerance);
    ++compared;
  }
  EXPECT_GT(compared, 50u);
}

TEST(PointLamp, BringsIntensityTimesCosineOverSquaredDistance) {
  expect_on_leaves(floor_under(point_lamp({0.5, 2, 0.3}, 100)), 6, 0.02, [](Vec3 p) {
    const Vec3 way = Vec3{0.5, 2, 0.3} - p;
    return 100 * way.y / std::pow(length(way), 3);
  });
}

TEST(SpotLamp, IsFullInTheInnerConeAndDarkOutsideTheOuter) {
  const Light spot = spot_lamp({0, 2, 0}, {0, -1, 0}, 0.3, 0.6);
  expect_on_leaves(floor_under(spot), 6, 0.05, [](Vec3 p) {
    const Vec3 way = Vec3{0, 2, 0} - p;
    const double angle = std::acos(way.y / length(way)), full = 100 * way.y / std::pow(length(way), 3);
    // Leaves that the edge of a cone may cross are not compared: a leaf is 0.125 m wide, 0.06 radians.
    return angle < 0.24 ? full : angle > 0.66 ? 0 : std::nan("");
  });
}

TEST(SpotLamp, RadiatesTheIntegralOfItsIntensity) {
  for (const auto& [inner, outer] : {std::pair{0.0, pi / 4}, {0.3, 0.6}, {0.5, 0.5}, {0.0, 0.01}, {0.2, pi}}) {
    const Light spot = spot_lamp({}, {0, 0, 1}, inner, outer);
    double sum = 0;  // over the cosine, from the edge of the light to the axis
    const double range = 1 - std::cos(outer);
    constexpr int n = 200'000;
    for (int k = 0; k < n; ++k) sum += SpotCone(spot).share(1 - (k + 0.5) / n * range) * range / n;
    EXPECT_NEAR(radiated_power(spot).g, 2 * pi * 100 * sum, 1e-3 * radiated_power(spot).g) << inner << ' ' << outer;
  }
  EXPECT_NEAR(radiated_power(point_lamp({}, 100)).g, 4 * pi * 100, 1e-9);
}

TEST(Sun, BringsItsIrradianceTimesTheCosine) {
  const Vec3 direction = normalized(Vec3{1, -2, 0.5});
  expect_on_leaves(floor_under(sun(direction, 1000)), 4, 1e-2, [&](Vec3) { return -1000 * direction.y; });
}

TEST(Sun, ThrowsAHalfShadowOfTheWidthOfItsDisk) {
  // A screen 4 m above the floor ends at x = 0; its half shadow is 4 m times the angular diameter wide.
  constexpr double angle = 0.2, height = 4;
  Scene scene = floor_under(sun({0, -1, 0}, 1000, angle));
  test::add_polygon(scene, {{-4, height, -4}, {0, height, -4}, {0, height, 4}, {-4, height, 4}});
  const double half_width = height * std::tan(angle / 2);
  expect_on_leaves(scene, 6, 120, [&](Vec3 p) {
    if (p.y > 0 || std::abs(p.z) > 3 || p.x > 3 || p.x < -3) return std::nan("");
    // The share of a disk on one side of a line at the distance s of its middle.
    const double s = std::clamp(p.x / half_width, -1.0, 1.0);
    return 1000 * (0.5 + (s * std::sqrt(1 - s * s) + std::asin(s)) / pi);
  });
}

/// CIE 171:2006, test 5.8: the mean illuminance of a cube around an isotropic lamp is Phi / (S (1 - rho)).
class LampInACube : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Reflectances, LampInACube, testing::Values(0.0, 0.2, 0.5, 0.8, 0.9, 0.95),
                         [](const auto& rho) { return "PerMille" + std::to_string(std::lround(1000 * rho.param)); });

TEST_P(LampInACube, HasTheKnownMeanIlluminance) {
  Scene scene;
  scene.materials = {test::grey(0, GetParam())};
  test::add_box(scene, {0, 0, 0}, {4, 4, 4}, true);
  scene.lights = {point_lamp({2, 2, 2}, 10'000 / (4 * pi))};
  const BaseMesh mesh(scene);
  const double expected = 10'000 / (96 * (1 - GetParam()));
  EXPECT_NEAR(mean_irradiance(mesh, test::solved(mesh, {.tolerance = 0.01})), expected, 0.005 * expected);
}

/// Returns each kind of light that there is, over the floor of a room with two blocks.
OwnedLights all_kinds(const LocalScene& scene) {
  OwnedLights lights = lights_beside_faces(scene, EmissionUnit(scene.mesh()));
  for (auto& face : lights_of_faces(scene, EmissionUnit(scene.mesh()))) lights.push_back(std::move(face));
  return lights;
}

Scene room_with_all_kinds() {
  Scene scene = test::coloured_room();
  scene.lights = {point_lamp({2, 2, 2}, 10), spot_lamp({1, 2.5, 1}, {0.2, -1, 0.3}, 0.2, 0.8), sun({0.3, -1, 0.2}, 50),
                  sun({-0.3, -1, 0.2}, 50, 0.1), point_lamp({3, 1.5, 4}, 20)};
  scene.lights.back().radius = 0.3;
  test::add_globe(scene, {3, 2, 2}, 0.25, 2, 1);
  // Its planes differ as little as those of measured webs, which are closer: sharp kinks would need finer rules.
  const auto web = std::make_shared<PhotometricWeb>(PhotometricWeb{
      .planes = {0, 90, 180, 270, 360}, .angles = {0, 20, 60, 180}, .intensities = {9,   9, 7, 1, 9,   9, 6, 2, 9, 9,
                                                                                    7.5, 0, 9, 9, 5.5, 1, 9, 9, 7, 1}});
  using Shape = LuminousOpening::Shape;
  for (const LuminousOpening& opening : {LuminousOpening{},
                                         {Shape::rectangle, 0.6, 0.3, 0},
                                         {Shape::ellipse, 0.6, 0.3, 0},
                                         {Shape::box, 0.6, 0.3, 0.2},
                                         {Shape::cylinder, 0.4, 0.3, 0.3},
                                         {Shape::sphere, 0.4, 0, 0}}) {
    Light light = point_lamp({2, 2.2, 3}, 1);
    light.kind = LightKind::luminaire;
    light.direction = normalized(Vec3{0.2, -1, 0.1});
    light.across = normalized(cross(light.direction, {0, 0, 1}));
    light.opening = opening;
    light.web = web;
    scene.lights.push_back(light);
  }
  return scene;
}

// This is what lets the solver use a light without knowing of what kind it is.
TEST(EveryLight, BringsAsMuchByItsRaysAsByItsFormula) {
  const BaseMesh mesh(room_with_all_kinds());
  const LocalScene scene(mesh);
  for (const auto& light : all_kinds(scene)) test::expect_rays_match_formula(scene, *light, 4096, 0.01);
}

TEST(EveryLight, BringsNoMoreThanItsExtentAllows) {
  const BaseMesh mesh(room_with_all_kinds());
  const LocalScene scene(mesh);
  RandomStream random(1, PatchId::root(0));
  const auto place = [&] { return Vec3{random.next() - 0.5, random.next() - 0.5, random.next() - 0.5}; };
  for (const auto& light : all_kinds(scene)) {
    const auto extent = light->extent();
    if (!extent) continue;
    for (int n = 0; n < 2000; ++n) {
      const Vec3 at = place(), away = place();
      const auto outside = [](double x, double low, double high) { return std::max({low - x, x - high, 0.0}); };
      const Vec3 gap{outside(at.x, extent->low.x, extent->high.x), outside(at.y, extent->low.y, extent->high.y),
                     outside(at.z, extent->low.z, extent->high.z)};
      const double brings = light->unblocked(at, normalized(away)) * light->colour().sum();
      EXPECT_LE(brings, extent->brightest * (1 + 1e-9));
      EXPECT_LE(brings * pi * dot(gap, gap), extent->power * (1 + 1e-9)) << "light " << light->number();
    }
  }
}

TEST(ManyLamps, AreAsBrightByTheTreeAsOneByOne) {
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_box(scene, {0, 0, 0}, {8, 3, 8}, true);
  for (int n = 0; n < 64; ++n) scene.lights.push_back(point_lamp({0.5 + n % 8, 2.7, 0.5 + n / 8}, 10));
  scene.lights.push_back(sun({0.1, -1, 0}, 30));  // shut out by the ceiling's back
  const BaseMesh mesh(scene);
  // All light of the lamps meets the walls; none is reflected.
  const double expected = 64 * 4 * pi * 10 / (2 * 64 + 4 * 24);
  EXPECT_NEAR(mean_irradiance(mesh, test::solved(mesh, {.tolerance = 0.02})), expected, 0.01 * expected);
}

TEST(MeshLight, IsALampOfManyConnectedFacesOfOneMaterial) {
  Scene scene = test::coloured_room();
  const auto lights_of = [](const Scene& each) {
    const BaseMesh mesh(each);
    const LocalScene local(mesh);
    return lights_of_faces(local, EmissionUnit(mesh)).size();
  };
  test::add_globe(scene, {3, 2, 2}, 0.25, 2, 1);  // 128 faces
  EXPECT_EQ(lights_of(scene), 2u);                // and the lamp at the ceiling
  test::add_globe(scene, {1, 2, 2}, 0.25, 0, 1);
  EXPECT_EQ(lights_of(scene), 3u);
  scene.materials.push_back(test::grey(20, 0));
  scene.faces.back().material = 3;
  EXPECT_EQ(lights_of(scene), 10u);  // seven faces are fewer than a lamp has
  Scene large = test::coloured_room();
  test::add_globe(large, {2, 1.5, 2.5}, 1.45, 1, 1);
  EXPECT_EQ(lights_of(large), 33u);
}

TEST(MeshLight, BringsWhatItsFacesBring) {
  Scene scene = test::coloured_room();
  test::add_globe(scene, {3, 2, 2}, 0.25, 2, 1);
  const BaseMesh mesh(scene);
  const LocalScene local(mesh);
  const EmissionUnit unit(mesh);
  const OwnedLights lights = lights_of_faces(local, unit);
  const LightSource& globe = *lights.back();
  const auto emission = emission_by_material(mesh, unit);
  RandomStream random(1, PatchId::root(0));
  double power = 0;
  for (std::uint32_t root = globe.number(); root < mesh.roots().size(); ++root)
    power += FaceLight(local, root, emission[1]).power();
  EXPECT_NEAR(globe.power(), power, 1e-9 * power);
  for (int n = 0; n < 200; ++n) {
    const Vec3 at = local.frame().to_local({4 * random.next(), 3 * random.next(), 5 * random.next()});
    const Vec3 normal =
        normalized(local.frame().to_local({3, 2, 2}) - at + 0.5 * Vec3{random.next(), random.next(), random.next()});
    if (length(at - local.frame().to_local({3, 2, 2})) * local.frame().metres_per_unit < 0.3) continue;
    double sum = 0;
    for (std::uint32_t root = globe.number(); root < mesh.roots().size(); ++root)
      sum += FaceLight(local, root, emission[1]).unblocked(at, normal);
    EXPECT_NEAR(globe.unblocked(at, normal), sum, 0.005 * sum + 1e-6);
  }
}

// Blender's exporter makes all materials two-sided unless it is told otherwise. The back of each face lies in the plane of its
// front.
TEST(MeshLight, OfTwoSidesShinesOnItsInsideAsAClosedSurfaceDoesAndNotOnItsOutside) {
  for (const auto& [offset, radius] : {std::pair{Vec3{}, 0.25}, {Vec3{}, 0.002}, {Vec3{1e6, 0, -1e6}, 0.25}}) {
    Scene scene = test::coloured_room();
    for (Vec3& vertex : scene.vertices) vertex = vertex + offset;
    scene.materials.push_back(test::grey(20, 0));
    scene.materials.back().two_sided = true;
    const Vec3 middle = Vec3{3.013, 2.017, 2.031} + offset;
    test::add_globe(scene, middle, radius, 1, 3);
    const BaseMesh mesh(scene);
    const LocalScene local(mesh);
    const OwnedLights lights = lights_of_faces(local, EmissionUnit(mesh));
    const LightSource& globe = *lights.back();
    const double rounding = 1e-9 + 1e-15 * length(offset) / radius;
    for (std::uint32_t root = globe.number(); root < mesh.roots().size(); ++root) {
      const RootPatch& patch = mesh.roots()[root];
      const bool is_inside = dot(patch.normal, middle - patch.at(0.3, 0.3)) > 0;
      for (int k = 0; k < 4; ++k) {
        const Uv at = PatchShape::whole(root, patch.corner_count).quarter_centre(k);
        EXPECT_NEAR(globe.unblocked(local.frame().to_local(patch.at(at.u, at.v)), patch.normal), is_inside, 10 * rounding);
      }
    }
  }
}

TEST(FaceLight, ShinesOnWhatIsJustBeforeItAndNotOnItsBack) {
  Scene scene;
  scene.materials = {test::grey(5, 0)};
  scene.materials[0].two_sided = true;
  test::add_polygon(scene, {{0, 0, 0}, {1, 0.3, 0}, {1, 1.3, 0.2 + 1e-6}, {0, 1, 0.2}});  // bent, as float coordinates are
  const BaseMesh mesh(scene);
  ASSERT_EQ(mesh.roots().size(), 2u);
  const LocalScene local(mesh);
  const FaceLight front(local, 0, {1, 1, 1});
  const RootPatch& patch = mesh.roots()[0];
  for (const Uv at : {Uv{0.2, 0.2}, Uv{0.7, 0.3}, Uv{0.5, 0.9}}) {
    EXPECT_EQ(front.unblocked(local.frame().to_local(patch.at(at.u, at.v)), -patch.normal), 0);
    EXPECT_NEAR(front.unblocked(local.frame().to_local(patch.at(at.u, at.v) + 1e-4 * patch.normal), -patch.normal), 1, 1e-3);
  }
}

// As one light the globe casts shadows without the noise of drawing its faces.
TEST(MeshLight, OfManyFacesIsAsEasyAsASphere) {
  const auto outcome_of = [](const Scene& scene) {
    const BaseMesh mesh(scene);
    SolutionLog log;
    const StopReason reason = solve(mesh, {.tolerance = 0.03, .max_leaves = 50'000}, log, {}).reason;
    return std::pair(reason, mean_irradiance(mesh, log.leaves()));
  };
  Scene room;
  room.materials = {test::grey(0, 0.5), test::grey(100, 0)};
  test::add_box(room, {0, 0, 0}, {4, 3, 5}, true);
  test::add_box(room, {1, 0, 1}, {2, 1, 3}, false);
  Scene globe = room, sphere = room;
  test::add_globe(globe, {2.5, 2, 2.5}, 0.2, 3, 1);  // 512 faces
  double area = 0;
  const BaseMesh mesh(globe);
  for (std::uint32_t root = 12; root < mesh.roots().size(); ++root) area += mesh.roots()[root].area;
  sphere.lights = {point_lamp({2.5, 2, 2.5}, 100 * area / (4 * pi))};
  sphere.lights[0].radius = 0.2;
  const auto [reason, mean] = outcome_of(globe);
  EXPECT_EQ(reason, StopReason::tolerance);
  // The globe's own faces count for its mean, but the room is far larger.
  EXPECT_NEAR(mean, outcome_of(sphere).second, 0.02 * mean);
}

TEST(PlanOfLamps, LightsTheRoomThatTheLampIsInAndNoOther) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5)};
  test::add_box(scene, {0, 0, 0}, {2, 2, 2}, true);
  test::add_box(scene, {5, 0, 0}, {7, 2, 2}, true);
  scene.lights = {point_lamp({1, 1, 1}, 10)};
  const auto lit_rooms = [](const Scene& of) {
    const BaseMesh mesh(of);
    const Plan plan(mesh, {});
    return std::pair(plan.may_be_lit(0), plan.may_be_lit(6));
  };
  EXPECT_EQ(lit_rooms(scene), std::pair(true, false));
  scene.lights[0].position = {6, 1, 1};
  EXPECT_EQ(lit_rooms(scene), std::pair(false, true));
  scene.lights = {sun({0, -1, 0}, 10)};
  EXPECT_EQ(lit_rooms(scene), std::pair(false, false));
}

TEST(PlanOfLamps, AFloorWithNothingAboveButTheSunIsLit) {
  const BaseMesh mesh(floor_under(sun({0, -1, 0}, 10)));
  EXPECT_TRUE(Plan(mesh, {}).may_be_lit(0));
  const BaseMesh below(floor_under(sun({0, 1, 0}, 10)));
  EXPECT_FALSE(Plan(below, {}).may_be_lit(0));
}

TEST(PowerBalance, OfTheSunCountsWhatFirstArrives) {
  Scene scene = floor_under(sun({0, -1, 0}, 10));
  scene.materials[0].reflectance = {0.5, 0.5, 0.5};
  const BaseMesh mesh(scene);
  SolutionLog log;
  const SolveOutcome outcome = solve(mesh, {}, log, {});
  EXPECT_NEAR(outcome.balance.emitted, 3 * 10 * 64, 1);  // three bands, 64 m2
  EXPECT_NEAR(outcome.balance.absorbed, 0.5 * outcome.balance.emitted, 1);
  EXPECT_NEAR(outcome.balance.lost, 0.5 * outcome.balance.emitted, 1);
}

/// Returns a floor of 4 x 4 m and a wall, and a bulb between them and the open sky.
Scene open_corner() {
  Scene scene;
  scene.materials.push_back(test::grey(0, 0.5));
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}}, 0);
  test::add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 2, 0}, {0, 2, 0}}, 0);
  Light bulb{"bulb", LightKind::point, {1, 1, 1}, {2, 1.5, 2}};
  bulb.radius = 0.1;
  scene.lights = {bulb};
  return scene;
}

TEST(Lamps, LightThatLeavesTheSceneIsNoError) {
  const BaseMesh mesh(open_corner());
  SolutionLog log;
  const SolveOutcome outcome = solve(mesh, {.tolerance = 0.03, .max_leaves = 20'000}, log, {});
  EXPECT_EQ(outcome.reason, StopReason::tolerance) << log.last_step().estimated_error;
  EXPECT_NEAR(outcome.balance.gap(), 0, 0.01);
  EXPECT_NEAR(outcome.balance.emitted, 3 * 4 * std::numbers::pi, 1e-6) << "1 W/sr in each of three bands";
  EXPECT_GT(outcome.balance.lost, 0.4 * outcome.balance.emitted) << "the upper half, and more";
}

TEST(Lamps, LightThatFadesInTheMediumIsNoError) {
  Scene scene = test::coloured_room();
  scene.materials[1].emission = {};
  scene.absorption = {0.3, 0.3, 0.3};
  Light bulb{"bulb", LightKind::point, {1, 1, 1}, {2, 2, 4}};
  bulb.radius = 0.1;
  scene.lights = {bulb};
  const BaseMesh mesh(scene);
  SolutionLog log;
  const SolveOutcome outcome = solve(mesh, {.tolerance = 0.05, .max_leaves = 20'000}, log, {});
  EXPECT_EQ(outcome.reason, StopReason::tolerance) << log.last_step().estimated_error;
  EXPECT_NEAR(outcome.balance.gap(), 0, 0.02);
}

}  // namespace
}  // namespace alvor
