// Environment maps, against closed forms and lights of other kinds.

#include "radiosity/direct/environment_band.h"
#include "radiosity/direct/lights_of_scene.h"
#include "radiosity/plan/plan.h"
#include "tests/environments.h"
#include "tests/radiosity/light_rays.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using std::numbers::pi;

Scene floor_under(const Light& light, double reflectance = 0) {
  Scene scene;
  scene.materials = {test::grey(0, reflectance)};
  test::add_polygon(scene, {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
  scene.lights = {light};
  return scene;
}

Light uniform(const Rgb& radiance) {
  return test::environment({16, 8}, [&](Vec3) { return radiance; });
}

/// A sky that is brighter towards one side, above a dim ground of another colour.
Light coloured() {
  return test::environment({64, 32}, [](Vec3 d) {
    const double bright = std::exp(4 * (dot(d, normalized(Vec3{0.5, 0.6, -0.6})) - 1));
    return d.y > 0 ? Rgb{1 + 4 * bright, 1.5 + 3 * bright, 3} : Rgb{0.4, 0.5, 0.2};
  });
}

TEST(Environment, ThatIsConstantBringsPiTimesItsRadiance) {
  const BaseMesh mesh(floor_under(uniform({2, 2, 2}), 0.5));
  SolutionLog log;
  const SolveOutcome outcome = solve(mesh, {}, log, {});
  for (const LeafValue& leaf : log.leaves()) EXPECT_NEAR(leaf.irradiance.g, 2 * pi, 1e-3 * 2 * pi);
  EXPECT_NEAR(outcome.balance.emitted, 3 * 2 * pi * 64, 1e-2 * 3 * 2 * pi * 64);
}

TEST(Environment, ThatIsConstantLightsAllSidesAlike) {
  const BaseMesh mesh(floor_under(uniform({1, 2, 3})));
  const LocalScene scene(mesh);
  const EmissionUnit unit(mesh);
  const auto lights = lights_beside_faces(scene, unit);
  ASSERT_EQ(lights.size(), 1u) << "one colour is one light";
  for (const Vec3 normal : {Vec3{0, 1, 0}, {0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {0.6, 0.8, 0}, {0.48, -0.6, 0.64}}) {
    const Rgb light = unit.to_watts_per_m2(lights[0]->unblocked({}, normal) * lights[0]->colour());
    EXPECT_NEAR(light.r, pi, 1e-3 * pi);
    EXPECT_NEAR(light.b, 3 * pi, 3e-3 * pi);
  }
}

TEST(Environment, WithOneBrightBlockEqualsADistantLight) {
  const Vec3 towards = normalized(Vec3{1, 1.5, 0.5});
  const Light block = test::environment({256, 128}, [&](Vec3 d) {
    return (dot(d, towards) > std::cos(0.03) ? 1000 : 0) * Rgb{1, 1, 1};
  });
  Vec3 sum;
  const EnvironmentMap& map = *block.environment;
  for (std::uint32_t row = 0; row < map.grid.rows; ++row)
    for (std::uint32_t column = 0; column < map.grid.columns; ++column)
      sum += double{map.pixels[row * map.grid.columns + column].g} *
             EnvironmentAxes(block).to_scene(map.grid.direction_sum(row, column));
  Scene scene = floor_under(block);
  test::add_box(scene, {-1, 0, -1}, {0, 1, 1}, false);
  const auto by_block = test::solved(BaseMesh(scene), {.tolerance = 0.01});
  Light sun;
  sun.kind = LightKind::directional;
  sun.direction = -normalized(sum);
  sun.intensity = length(sum) * Rgb{1, 1, 1};
  sun.angular_diameter = 0.06;
  scene.lights = {sun};
  const BaseMesh mesh(scene);
  const auto by_sun = test::solved(mesh, {.tolerance = 0.01});
  const auto mean_of_roots = [&](const std::vector<LeafValue>& leaves) {
    std::vector<double> mean(mesh.roots().size());
    for (const LeafValue& leaf : leaves) {
      const PatchShape shape = shape_of(mesh, leaf.patch);
      mean[shape.root] += area_of(mesh, shape) / mesh.roots()[shape.root].area * double{leaf.irradiance.g};
    }
    return mean;
  };
  const std::vector<double> a = mean_of_roots(by_block), b = mean_of_roots(by_sun);
  for (std::size_t root = 0; root < a.size(); ++root) EXPECT_NEAR(a[root], b[root], 0.02 * b[root] + 1e-3) << root;
}

TEST(Environment, OfTwoColoursLightsOppositeSidesByTheirs) {
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, false);
  // The left half of the image lies towards -z.
  scene.lights = {test::environment({64, 32}, [](Vec3 d) { return d.z < 0 ? Rgb{1, 0, 0} : Rgb{0, 0, 2}; })};
  EXPECT_EQ(scene.lights[0].environment->pixels[16 * 64 + 10], (RgbF{1, 0, 0}));
  const BaseMesh mesh(scene);
  for (const LeafValue& leaf : test::solved(mesh, {})) {
    const Vec3 normal = mesh.roots()[leaf.patch.root_face()].normal;
    EXPECT_NEAR(leaf.irradiance.r, pi * (1 - normal.z) / 2, 0.01 * pi);
    EXPECT_NEAR(leaf.irradiance.b, pi * (1 + normal.z), 0.02 * pi);
    EXPECT_EQ(leaf.irradiance.g, 0);
  }
}

TEST(Environment, OfAColourMakesThePlanCountColours) {
  Scene scene = floor_under(uniform({1, 1, 0.7}), 0.5);
  const auto has_bands = [](const Scene& of) { return Plan(BaseMesh(of), {}).needs(Feature::three_bands); };
  EXPECT_TRUE(has_bands(scene));
  scene.lights = {uniform({1, 1, 1})};
  EXPECT_FALSE(has_bands(scene));
}

TEST(Environment, OfOneColourIsOneLightAndOthersAreOneByBand) {
  EXPECT_EQ(bands_of(*uniform({1, 2, 0}).environment).size(), 1u);
  EXPECT_EQ(bands_of(*coloured().environment).size(), 3u);
  EXPECT_EQ(bands_of(*test::environment({8, 4}, [](Vec3 d) { return Rgb{1 + d.x, 0, 1}; }).environment).size(), 2u);
  EXPECT_TRUE(bands_of(*uniform({0, 0, 0}).environment).empty());
}

TEST(Environment, ReachesFacesThatLookDownAndNoSealedRoom) {
  Scene scene = floor_under(uniform({1, 1, 1}));
  std::ranges::reverse(scene.corners);
  EXPECT_TRUE(Plan(BaseMesh(scene), {}).may_be_lit(0));
  Scene sealed;
  sealed.materials = {test::grey(0, 0)};
  test::add_box(sealed, {0, 0, 0}, {4, 3, 4}, true);
  sealed.lights = scene.lights;
  EXPECT_FALSE(Plan(BaseMesh(sealed), {}).may_be_lit(0));
}

void expect_rays_match_formula(const Scene& of, double tolerance) {
  const BaseMesh mesh(of);
  const LocalScene scene(mesh);
  for (const auto& light : lights_beside_faces(scene, EmissionUnit(mesh)))
    test::expect_rays_match_formula(scene, *light, 16384, tolerance);
}

TEST(Environment, BringsAsMuchByItsRaysAsByItsFormulaInTheOpen) { expect_rays_match_formula(floor_under(coloured()), 0.005); }

TEST(Environment, BringsAsMuchByItsRaysAsByItsFormulaThroughAWindow) {
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  std::erase_if(scene.faces, [&](const Face& face) {
    return std::ranges::all_of(scene.corners_of(face), [&](std::uint32_t v) { return scene.vertices[v].z == 0; });
  });
  test::add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}});
  scene.lights = {coloured()};
  expect_rays_match_formula(scene, 0.02);
}

TEST(EnvironmentBand, DrawsDirectionsByItsRadiance) {
  const EnvironmentBand band(coloured(), {0, 1, 0});
  const Vec3 aim = normalized(Vec3{0.4, 0.5, -0.7});
  constexpr int n = 256;
  double within = 0, expected = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) within += dot(band.drawn((i + 0.5) / n, (j + 0.5) / n), aim) > 0.8;
  for (int i = 0; i < n; ++i)  // even by solid angle about y
    for (int j = 0; j < n; ++j) {
      const double y = 2 * (i + 0.5) / n - 1, turn = 2 * pi * (j + 0.5) / n, level = std::sqrt(1 - y * y);
      const Vec3 direction{level * std::cos(turn), y, level * std::sin(turn)};
      if (dot(direction, aim) > 0.8) expected += band.radiance(direction) * 4 * pi / (n * n);
    }
  EXPECT_NEAR(within / (n * n), expected, 0.01);
}

}  // namespace
}  // namespace alvor
