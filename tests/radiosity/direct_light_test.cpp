#include "radiosity/direct_light.h"

#include "radiosity/form_factor.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <numbers>

namespace alvor {
namespace {

constexpr double emission = 100;

/// A lamp of 1 m2, two metres above a floor patch; `blocker` hangs half way.
Scene lamp_and_floor(bool blocker, double x_from = -5) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(emission, 0)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0}});
  test::add_polygon(scene, {{-0.5, 2, -0.5}, {0.5, 2, -0.5}, {0.5, 2, 0.5}, {-0.5, 2, 0.5}}, 1);
  if (blocker) test::add_polygon(scene, {{x_from, 1, -5}, {5, 1, -5}, {5, 1, 5}, {x_from, 1, 5}});
  return scene;
}

DirectLight light_on_floor(const BaseMesh& mesh, std::uint64_t seed = 1) {
  const LocalScene scene(mesh);
  RayBudget budget([] { return false; });
  const Receiver receiver{PatchId::root(0), shape_of(mesh, PatchId::root(0)), 0};
  DirectLight light;
  const Emitter lamp{1, {emission, emission, emission}, 1};
  add_direct_light(scene, {&lamp, 1}, {&receiver, 1}, seed, budget, {&light, 1});
  return light;
}

TEST(DirectLight, UnblockedIsExact) {
  const BaseMesh mesh(lamp_and_floor(false));
  double exact = 0;  // mean over the patch by a fine midpoint rule
  constexpr int n = 16;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      exact += point_to_polygon(mesh.roots()[0].at((i + 0.5) / n, (j + 0.5) / n), {0, 1, 0}, mesh.roots()[1].corners) / (n * n);
  const DirectLight light = light_on_floor(mesh);
  EXPECT_EQ(light.variance, 0);
  // Four midpoints stand for the patch: their rule errs by about (size / distance)^2 / 10.
  EXPECT_NEAR(light.irradiance.g, emission * exact, 0.1 * 0.05 * 0.05 * emission * exact);
}

TEST(DirectLight, FullyBlockedIsZero) { EXPECT_TRUE(light_on_floor(BaseMesh(lamp_and_floor(true))).irradiance.is_zero()); }

TEST(DirectLight, HalfBlockedMatchesTheVisibleHalf) {
  // The screen hides what lies beyond x = 0.05 as seen from half way: about half of the lamp.
  const BaseMesh mesh(lamp_and_floor(true, 0.025));
  const Vec3 at{0.05, 0, 0.05};
  const Vec3 visible[] = {{-0.5, 2, -0.5}, {0.0, 2, -0.5}, {0.0, 2, 0.5}, {-0.5, 2, 0.5}};
  const double exact = emission * point_to_polygon(at, {0, 1, 0}, visible);
  double mean = 0, squares = 0;
  constexpr int seeds = 32;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const DirectLight light = light_on_floor(mesh, seed);
    EXPECT_GT(light.variance, 0);
    mean += light.irradiance.g / seeds;
    squares += light.irradiance.g * light.irradiance.g / seeds;
  }
  const double standard_error = std::sqrt((squares - mean * mean) / seeds);
  // The visible edge moves by 5 % of the lamp's width from one side of the patch to the other, evenly about the middle.
  EXPECT_NEAR(mean, exact, 3 * standard_error + 2e-3 * exact);
}

}  // namespace
}  // namespace alvor
