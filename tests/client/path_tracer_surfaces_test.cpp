// Tests of path tracing through translucent surfaces and holes, against closed forms.

#include "tests/client/path_tracing.h"
#include "tests/cutouts.h"
#include "tests/environments.h"

#include <gtest/gtest.h>

#include <numbers>
#include <vector>

namespace alvor {
namespace {

using std::numbers::pi;
using test::add_polygon;

Rgb all(double value) { return {value, value, value}; }

Material sheet(const Rgb& emission, const Rgb& reflectance, const Rgb& scattered) {
  return {"sheet", emission, reflectance, true, {}, std::nullopt, scattered};
}

/// Returns a two-sided material of which the image says what is there; it reflects half of what the image says.
Material card(ColourImage image, const Rgb& through = {}) {
  Material material = test::textured(std::move(image), all(0.5), Wrap::clamp);
  material.two_sided = true;
  material.regular_transmittance = through;
  return material;
}

/// Adds a square of this side about the z axis at height z, facing down, on which the image lies once: s along x, t along y.
void add_card(Scene& scene, double side, double z, std::uint32_t material) {
  const double h = side / 2;
  test::add_textured(scene, {{-h, -h, z}, {-h, h, z}, {h, h, z}, {h, -h, z}}, {{0, 0}, {0, 1}, {1, 1}, {1, 0}}, material);
}

Light sun_along(Vec3 direction) {
  Light sun{"sun", LightKind::directional, {10, 10, 10}};
  sun.direction = direction;
  return sun;
}

/// Adds a sheet to a furnace whose irradiance is 1; expects that it changes nothing, as all surfaces are equally bright.
void expect_no_change_in_a_furnace(const Material& material) {
  Scene scene = test::furnace(0.5, 0.5);
  scene.materials.push_back(material);
  test::add_textured(scene, {{1, 0.2, 0.5}, {1, 1.8, 0.5}, {1, 1.8, 3.5}, {1, 0.2, 3.5}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, 1);
  test::add_textured(scene, {{2, 0.2, 0.5}, {2, 1.8, 0.5}, {2.3, 1.8, 3.5}, {2.3, 0.2, 3.5}}, {{0, 0}, {1, 0}, {1, 1}, {0, 1}},
                     1);
  ASSERT_FALSE(find_fault(scene));
  for (const SurfacePoint& point : {SurfacePoint{{1.5, 0, 2}, {0, 1, 0}}, {{1, 1, 2}, {1, 0, 0}}, {{1, 0.9, 2}, {-1, 0, 0}}}) {
    const auto estimate = traced(scene, point);
    EXPECT_NEAR(estimate.mean().mean(), 1, sure * error_of(estimate) + 1e-9);
    EXPECT_LT(error_of(estimate), 0.03);
  }
}

TEST(PathTracer, TranslucentSheetsThatGiveOffWhatTheyAbsorbChangeNothingInAFurnace) {
  for (const auto& [reflectance, scattered] : {std::pair{0.0, 0.9}, {0.3, 0.3}, {0.6, 0.2}})
    expect_no_change_in_a_furnace(sheet(all(1 - reflectance - scattered), all(reflectance), all(scattered)));
}

TEST(PathTracer, HolesChangeNothingInAFurnace) {
  const double reflectance = 0.5 * reflectance_of_texel(255);
  for (const ColourImage& image : {test::lattice(8, 255), test::cut_out(2, 1, 255, {100, 200})}) {
    expect_no_change_in_a_furnace(card(image, all(1 - reflectance)));
    Material bright = card(image);
    bright.emission = all(1 - reflectance);
    expect_no_change_in_a_furnace(bright);
    bright.emission = all(1 - reflectance - 0.25);
    bright.diffuse_transmittance = all(0.25);
    expect_no_change_in_a_furnace(bright);
  }
}

TEST(PathTracer, ASunnySheetSendsItsSharesToBothSides) {
  Scene scene;
  scene.materials = {sheet({}, {0.5, 0.2, 0}, {0.1, 0.4, 0.7})};
  add_ceiling(scene, 2, 1, 0);
  add_black_floor(scene, 0.02);  // its shadow takes 1e-4 of the sheet's area
  const double form_factor = 4 * corner_form_factor(1, 1);
  for (const bool from_above : {false, true}) {
    scene.lights = {sun_along({0, 0, from_above ? -1.0 : 1.0})};
    const Rgb share = from_above ? scene.materials[0].diffuse_transmittance : scene.materials[0].reflectance;
    const auto estimate = traced(scene, {{0, 0, 0}, {0, 0, 1}}, 1 << 15);
    const Rgb error = estimate.variance(), expected = 10 * form_factor * share;
    EXPECT_NEAR(estimate.mean().r, expected.r, sure * std::sqrt(error.r) + 1e-3 * expected.r) << from_above;
    EXPECT_NEAR(estimate.mean().g, expected.g, sure * std::sqrt(error.g) + 1e-3 * expected.g) << from_above;
    EXPECT_NEAR(estimate.mean().b, expected.b, sure * std::sqrt(error.b) + 1e-3 * expected.b) << from_above;
    EXPECT_LT(error_of(estimate), 0.03 * expected.mean());
  }
}

/// Returns a box of 3 x 2 x 4 m under an environment of radiance 2. Its texture, if it has any, is one texel.
Scene box_under_even_sky(const Material& material) {
  Scene scene = test::furnace(0, 0);
  scene.materials = {material};
  if (material.texture) test::complete_texture_points(scene);
  scene.lights = {test::environment({16, 8}, [](Vec3) { return Rgb{2, 2, 2}; })};
  return scene;
}

// Seen from outside the box is convex, so the even sky lights all of it alike with S = pi L. Inside, each way meets the box once:
// H = (straight share) S + B, and B = (reflected share) H + (scattered share) S.
TEST(PathTracer, ABoxUnderAnEvenSkyIsEvenlyLit) {
  constexpr double sky = 2 * pi, half = 128.0 / 255, half_reflectance = 0.5;
  Material paper = sheet({}, all(0.5), all(0.3)), thin = sheet({}, all(0.2), all(0.5)), gauze = sheet({}, all(0.3), all(0.2));
  gauze.regular_transmittance = all(0.4);
  Material leaf = card(test::cut_out(1, 1, 255, {128}), all(0.25));
  leaf.diffuse_transmittance = all(0.2);
  Material hole = card(test::cut_out(1, 1, 255, {0}));
  hole.emission = all(5);
  const double rho = half_reflectance * reflectance_of_texel(255);
  const std::vector<std::pair<Material, double>> cases{
      {paper, 0.3 / (1 - 0.5)},
      {thin, 0.5 / (1 - 0.2)},
      {gauze, (0.4 + 0.2) / (1 - 0.3)},
      {leaf, (half * 0.25 + 1 - half + half * 0.2) / (1 - half * rho)},
      {hole, 1},
  };
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const Scene scene = box_under_even_sky(cases[n].first);
    ASSERT_FALSE(find_fault(scene)) << n;
    const double expected = cases[n].second * sky;
    for (const SurfacePoint& point : {SurfacePoint{{1.5, 0, 2}, {0, 1, 0}}, {{0, 0.1, 0.1}, {1, 0, 0}}}) {
      const auto inside = traced(scene, point, 1 << 14);
      EXPECT_NEAR(inside.mean().mean(), expected, sure * error_of(inside) + 1e-3 * expected) << n;
      EXPECT_LT(error_of(inside), 0.03 * expected) << n;
    }
    const auto outside = traced(scene, {{3, 1, 2}, {1, 0, 0}});
    EXPECT_NEAR(outside.mean().mean(), sky, sure * error_of(outside) + 1e-3 * sky) << n;
  }
}

TEST(PathTracer, EachTexelLetsTheSunThroughAsItsOpacitySays) {
  Scene scene;
  scene.materials = {card(test::cut_out(2, 2, 0, {0, 255, 102, 255}), all(0.25))};
  add_card(scene, 4, 1, 0);
  add_black_floor(scene, 4);
  scene.lights = {sun_along({0, 0, -1})};
  ASSERT_FALSE(find_fault(scene));
  const auto light_at = [&](double x, double y) { return traced(scene, {{x, y, 0}, {0, 0, 1}}, 64).mean().g; };
  EXPECT_NEAR(light_at(-1.1, -0.8), 10, 1e-5);
  EXPECT_NEAR(light_at(1.2, -0.7), 10 * 0.25, 1e-5);
  EXPECT_NEAR(light_at(-0.9, 1.3), 10 * (0.4 * 0.25 + 0.6), 1e-5);
  EXPECT_NEAR(light_at(-0.001, -0.5), 10, 1e-5);  // texels end sharply
  EXPECT_NEAR(light_at(0.001, 0.6), 10 * 0.25, 1e-5);
}

// The board is mirrored into its complement, so it casts exactly half the light of a square emitter behind its middle.
TEST(PathTracer, HolesOfHalfTheAreaLetHalfTheLightThrough) {
  Scene scene;
  scene.materials = {test::grey(3, 0)};
  add_ceiling(scene, 1, 1, 0);
  add_black_floor(scene, 1);
  const SurfacePoint point{{0, 0, 0}, {0, 0, 1}};
  const double clear = 3 * 4 * corner_form_factor(0.5, 0.5);
  scene.materials.push_back(card(test::lattice(64, 0)));
  add_card(scene, 4, 0.5, 2);
  const auto estimate = traced(scene, point, 1 << 14);
  EXPECT_NEAR(estimate.mean().mean(), clear / 2, sure * error_of(estimate));
  EXPECT_LT(error_of(estimate), 0.01 * clear);
}

TEST(PathTracer, AnEmitterShinesWhereItIsThere) {
  Scene scene;
  Material lamp = card(test::cut_out(2, 1, 0, {51, 255}));
  lamp.emission = all(3);
  for (const bool two_sided : {false, true}) {
    lamp.two_sided = two_sided;
    scene = {};
    scene.materials = {lamp};
    add_card(scene, 1, 1, 0);
    add_black_floor(scene, 1);
    const double half = 2 * corner_form_factor(0.5, 0.5);
    const auto estimate = traced(scene, {{0, 0, 0}, {0, 0, 1}}, 1 << 14);
    EXPECT_NEAR(estimate.mean().mean(), 3 * (0.2 * half + half), sure * error_of(estimate));
    EXPECT_LT(error_of(estimate), 0.01 * 3 * half);
  }
}

TEST(PathTracer, WhatIsAllHoleEnclosesNothing) {
  for (const std::uint8_t opacity : {std::uint8_t{0}, std::uint8_t{255}}) {
    Scene scene = test::furnace(1, 0.5);
    scene.materials.push_back(card(test::cut_out(1, 1, 128, {opacity})));
    scene.materials[1].two_sided = false;
    test::add_box(scene, {1, 0, 1}, {2, 1, 2}, false, {1, 1, 1, 1, 1, 1});
    test::complete_texture_points(scene);
    const PathTracer tracer(scene);
    EXPECT_EQ(tracer.is_enclosed({{1.5, 0, 1.5}, {0, 1, 0}}, 64, PathRandom(1, 2, 3)), opacity == 255);
  }
}

TEST(PathTracer, HundredsOfHolesArePassed) {
  Scene scene;
  scene.materials = {card(test::cut_out(1, 1, 0, {0}))};
  scene.lights = {sun_along({0, 0, -1})};
  add_black_floor(scene, 4);
  for (int n = 0; n < 300; ++n) add_card(scene, 4, 1 + 0.002 * n, 0);
  const SurfacePoint point{{0.5, 0.3, 0}, {0, 0, 1}};
  EXPECT_NEAR(traced(scene, point, 4).mean().g, 10, 1e-5);
}

}  // namespace
}  // namespace alvor
