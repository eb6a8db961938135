#include "radiosity/direct/direct_light.h"

#include "radiosity/direct/face_light.h"
#include "radiosity/form_factors/form_factor.h"
#include "tests/radiosity/light_rays.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

namespace alvor {
namespace {

constexpr double emission = 100;

/// Returns a lamp of 1 m2 two metres above a floor patch, and if `blocker` is true a screen half way between, from x = `x_from`
/// on.
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
  const FaceLight lamp(scene, 1, {emission, emission, emission});
  const LightSource* const lights[]{&lamp};
  add_direct_light(scene, lights, {&receiver, 1}, seed, budget, {&light, 1});
  return light;
}

TEST(DirectLight, UnblockedIsExact) {
  const BaseMesh mesh(lamp_and_floor(false));
  double exact = 0;  // mean form factor over the patch, by a fine midpoint rule
  constexpr int n = 16;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      exact += point_to_polygon(mesh.roots()[0].at((i + 0.5) / n, (j + 0.5) / n), {0, 1, 0}, mesh.roots()[1].corners) / (n * n);
  const DirectLight light = light_on_floor(mesh);
  EXPECT_EQ(light.variance, 0);
  // The solver evaluates the form factor at four midpoints; that rule errs by about (size / distance)^2 / 10.
  EXPECT_NEAR(light.irradiance.g, emission * exact, 0.1 * 0.05 * 0.05 * emission * exact);
}

TEST(DirectLight, OnlyTheVisiblePartOfAPatchCounts) {
  // A lamp stands on the wall x = 0 and shines upwards: the part of the patch below its edge (u < 0.5) is hidden and would see
  // nothing.
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(emission, 0)};
  test::add_polygon(scene, {{0, -0.1, 0}, {0, 0.1, 0}, {0, 0.1, 0.1}, {0, -0.1, 0.1}});
  test::add_polygon(scene, {{0, 0, -1}, {0, 0, 1}, {1, 0, 1}, {1, 0, -1}}, 1);
  const BaseMesh mesh(scene);
  ASSERT_GT(mesh.roots()[0].normal.x, 0);
  const PatchShape shape = shape_of(mesh, PatchId::root(0));
  std::uint16_t hidden = 0;
  double exact = 0;
  for (int o = 0; o < origins_per_patch; ++o) {
    const Uv middle = shape.stratum_centre(o);
    const Vec3 at = mesh.roots()[0].at(middle.u, middle.v);
    if (at.y < 0) hidden |= static_cast<std::uint16_t>(1u << o);
    else exact += emission * point_to_polygon(at, {1, 0, 0}, mesh.roots()[1].corners) / 8;
  }
  ASSERT_EQ(std::popcount(hidden), 8);
  const LocalScene local(mesh);
  const FaceLight lamp(local, 1, {emission, emission, emission});
  const LightSource* const lights[]{&lamp};
  const Receiver receiver{PatchId::root(0), shape, hidden};
  for (const bool has_shadows : {false, true}) {
    RayBudget budget([] { return false; });
    DirectLight light;
    add_direct_light(local, lights, {&receiver, 1}, 1, budget, {&light, 1},
                     {.occlusion = has_shadows, .medium = false, .partial = false});
    // Two points stand for eight: the form factor bends little over 0.1 m before a lamp of 2 m.
    EXPECT_NEAR(light.irradiance.g, exact, 0.01 * exact) << has_shadows;
  }
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

/// Returns the light on the patches of one level of the floor (root 0) from the lamp (root 1).
std::vector<DirectLight> light_on_divided_floor(const BaseMesh& mesh, int level, std::uint64_t seed, std::uint8_t ray_level) {
  std::vector<Receiver> receivers;
  for (int n = 0; n < 1 << 2 * level; ++n) {
    PatchId patch = PatchId::root(0);
    for (int l = 0; l < level; ++l) patch = patch.child(n >> 2 * l & 3);
    receivers.push_back({patch, shape_of(mesh, patch), 0, ray_level});
  }
  const LocalScene scene(mesh);
  RayBudget budget([] { return false; });
  const FaceLight lamp(scene, 1, {emission, emission, emission});
  const LightSource* const lights[]{&lamp};
  std::vector<DirectLight> light(receivers.size());
  add_direct_light(scene, lights, receivers, seed, budget, light);
  return light;
}

/// Returns the lamp over a floor of 4 x 4 m.
Scene lamp_and_wide_floor() {
  Scene scene = lamp_and_floor(false);
  scene.vertices[0] = {-2, 0, -2}, scene.vertices[1] = {-2, 0, 2}, scene.vertices[2] = {2, 0, 2}, scene.vertices[3] = {2, 0, -2};
  return scene;
}

/// The noise of the direct light of some patches: the standard deviation that DirectLight::variance predicts, and the actual one
/// between seeds, both RMS over the patches; and the mean irradiance over patches and seeds.
struct Noise {
  double predicted = 0, actual = 0, mean = 0;
};
/// Finds the noise of the lamp's light on a floor that is divided into patches of a quarter metre.
Noise noise_on_divided_floor(const BaseMesh& mesh, std::uint8_t ray_level = 0) {
  constexpr int seeds = 32, level = 4;
  std::vector<double> sum(1 << 2 * level), squares(sum.size());
  double predicted = 0, actual = 0, all = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const auto light = light_on_divided_floor(mesh, level, seed, ray_level);
    for (std::size_t p = 0; p < light.size(); ++p) {
      sum[p] += light[p].irradiance.mean();
      squares[p] += std::pow(light[p].irradiance.mean(), 2);
      predicted += light[p].variance / seeds;
    }
  }
  for (std::size_t p = 0; p < sum.size(); ++p) {
    actual += (squares[p] - sum[p] * sum[p] / seeds) / (seeds - 1);
    all += sum[p] / seeds;
  }
  const auto patches = static_cast<double>(sum.size());
  return {std::sqrt(predicted / patches), std::sqrt(actual / patches), all / patches};
}

double predicted_over_actual_deviation(const BaseMesh& mesh) {
  const Noise noise = noise_on_divided_floor(mesh);
  return noise.predicted / noise.actual;
}

// Stratified rays have less noise than independent ones, by an amount that depends on the shadow's edge; hence the tolerance of a
// factor of two. (Along an edge that is parallel to the patches they have far less noise than that.)
TEST(DirectLight, VarianceIsTheSpreadOverSeedsWhereHalfTheFloorIsInShadow) {
  Scene scene = lamp_and_wide_floor();
  test::add_polygon(scene, {{-5, 1, -2}, {5, 1, 1}, {5, 1, 8}, {-5, 1, 8}});
  const double ratio = predicted_over_actual_deviation(BaseMesh(scene));
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2);
}

/// Adds a board of squares, of which every other one is missing.
void add_chequered_screen(Scene& scene) {
  for (int i = -20; i < 20; ++i)
    for (int j = -20 + (i & 1); j < 20; j += 2) {
      const double x = 0.05 * i, z = 0.05 * j;
      test::add_polygon(scene, {{x, 1, z}, {x + 0.05, 1, z}, {x + 0.05, 1, z + 0.05}, {x, 1, z + 0.05}});
    }
}

TEST(DirectLight, VarianceIsTheSpreadOverSeedsUnderManySmallBlockers) {
  Scene scene = lamp_and_wide_floor();
  add_chequered_screen(scene);
  const double ratio = predicted_over_actual_deviation(BaseMesh(scene));
  EXPECT_GT(ratio, 0.5);
  EXPECT_LT(ratio, 2);
}

// Four times the rays at each level: the noise falls as that of a net that one edge crosses, the mean stays.
TEST(DirectLight, MoreShadowRaysHaveTheNoiseThatIsToldAndTheSameMean) {
  Scene scene = lamp_and_wide_floor();
  test::add_polygon(scene, {{-5, 1, -2}, {5, 1, 1}, {5, 1, 8}, {-5, 1, 8}});
  const BaseMesh mesh(scene);
  Noise before = noise_on_divided_floor(mesh);
  for (std::uint8_t level = 1; level <= most_ray_level; ++level) {
    const Noise noise = noise_on_divided_floor(mesh, level);
    EXPECT_LT(noise.actual, before.actual / 2) << int(level);
    EXPECT_GT(noise.predicted, 0.5 * noise.actual) << int(level);
    EXPECT_LT(noise.predicted, 3 * noise.actual) << int(level);
    EXPECT_NEAR(noise.mean, before.mean, 1e-3 * before.mean) << int(level);
    before = noise;
  }
}

// A slat hides an eighth of a lamp, the same for all of a small patch: at every level some rays find it.
TEST(DirectLight, NoLevelOfShadowRaysMissesASlat) {
  Scene scene = lamp_and_floor(false);
  scene.vertices[1].z = scene.vertices[2].z = scene.vertices[2].x = scene.vertices[3].x = 0.01;
  test::add_polygon(scene, {{0.15, 1.9, -5}, {0.275, 1.9, -5}, {0.275, 1.9, 5}, {0.15, 1.9, 5}});
  const BaseMesh mesh(scene);
  const LocalScene local(mesh);
  const FaceLight lamp(local, 1, {emission, emission, emission});
  const LightSource* const lights[]{&lamp};
  for (std::uint8_t level = 0; level <= most_ray_level; ++level) {
    const Receiver receiver{PatchId::root(0), shape_of(mesh, PatchId::root(0)), 0, level};
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      RayBudget budget([] { return false; });
      DirectLight light;
      add_direct_light(local, lights, {&receiver, 1}, seed, budget, {&light, 1});
      EXPECT_GT(light.variance, 0) << int(level) << ' ' << seed;
    }
  }
}

/// Returns a tube of 2 x 0.02 m that hangs 5 cm above the middle of a floor of 10 cm, and between them screens with slits.
Scene tube_behind_slits() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(emission, 0)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0}});
  test::add_polygon(scene, {{-1, 0.05, 0.04}, {1, 0.05, 0.04}, {1, 0.05, 0.06}, {-1, 0.05, 0.06}}, 1);
  for (int n = -10; n < 10; ++n)
    test::add_polygon(scene, {{0.1 * n, 0.04, -1}, {0.1 * n + 0.07, 0.04, -1}, {0.1 * n + 0.07, 0.04, 1}, {0.1 * n, 0.04, 1}});
  return scene;
}

TEST(DirectLight, VarianceOfOriginsIsTheSpreadOverSeedsBesideALongLamp) {
  const BaseMesh mesh(tube_behind_slits());
  constexpr int seeds = 64;
  std::array<double, origins_per_patch> sum{}, squares{};
  double predicted = 0, actual = 0;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const DirectLight light = light_on_floor(mesh, seed);
    predicted += light.origin_variance / seeds;
    for (std::size_t o = 0; o < origins_per_patch; ++o)
      sum[o] += light.at_origin[o], squares[o] += light.at_origin[o] * light.at_origin[o];
  }
  for (std::size_t o = 0; o < origins_per_patch; ++o)
    actual += (squares[o] - sum[o] * sum[o] / seeds) / (seeds - 1) / origins_per_patch;
  EXPECT_GT(std::sqrt(predicted / actual), 0.5);
  EXPECT_LT(std::sqrt(predicted / actual), 2);
}

TEST(FaceLight, RaysToALongLampNearByBringAboutTheSame) {
  const BaseMesh mesh(tube_behind_slits());
  const LocalScene scene(mesh);
  const FaceLight tube(scene, 1, {emission, emission, emission});
  test::expect_rays_match_formula(scene, tube, 4096, 0.01);
  EXPECT_GT(test::rays_that_count(scene, tube, 4096), 0.5);
}

TEST(DirectLight, OriginsAverageToTheIrradianceWhereNothingIsInShadow) {
  const BaseMesh mesh(lamp_and_floor(false));
  for (const DirectLight& light : light_on_divided_floor(mesh, 1, 1, 0)) {
    double mean = 0;
    for (const float there : light.at_origin) mean += there / double(origins_per_patch);
    EXPECT_NEAR(mean, light.irradiance.mean(), 1e-3 * mean);
    EXPECT_EQ(light.origin_variance, 0);
  }
}

TEST(DirectLight, OriginsTellWhichHalfIsDark) {
  // A screen hangs one millimetre above half of a patch of 10 cm, so that its penumbra is only half a millimetre wide.
  Scene scene = lamp_and_floor(false);
  test::add_polygon(scene, {{0.05, 1e-3, -5}, {5, 1e-3, -5}, {5, 1e-3, 5}, {0.05, 1e-3, 5}});
  const BaseMesh mesh(scene);
  const PatchShape shape = shape_of(mesh, PatchId::root(0));
  const DirectLight light = light_on_floor(mesh), open = light_on_floor(BaseMesh(lamp_and_floor(false)));
  for (int o = 0; o < origins_per_patch; ++o) {
    const double x = centre_of(mesh, shape.child(o / 4).child(o % 4)).x;
    if (x > 0.05) EXPECT_EQ(light.at_origin[o], 0) << "origin " << o;
    else EXPECT_NEAR(light.at_origin[o], open.at_origin[o], 1e-3 * open.at_origin[o]) << "origin " << o;
  }
  EXPECT_NEAR(light.irradiance.mean(), open.irradiance.mean() / 2, 0.01 * open.irradiance.mean());
}

}  // namespace
}  // namespace alvor
