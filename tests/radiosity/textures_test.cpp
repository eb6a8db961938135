// Reflectance that varies over a face, against closed forms and against faces of one reflectance each.

#include "tests/textures.h"
#include "meshing/patch_reflectance.h"
#include "radiosity/plan/plan.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

namespace alvor {
namespace {

/// Returns the mean irradiance of each material's faces.
std::vector<Rgb> mean_by_material(const Scene& scene, const SolveOptions& options = {}) {
  const BaseMesh mesh(scene);
  std::vector<Rgb> sum(scene.materials.size());
  std::vector<double> area(scene.materials.size());
  for (const LeafValue& leaf : test::solved(mesh, options)) {
    const std::uint32_t material = mesh.roots()[leaf.patch.root_face()].material;
    const double a = area_of(mesh, shape_of(mesh, leaf.patch));
    sum[material] += a * widen(leaf.irradiance);
    area[material] += a;
  }
  for (std::size_t m = 0; m < sum.size(); ++m)
    if (area[m] > 0) sum[m] *= 1 / area[m];
  return sum;
}

constexpr std::uint32_t walls = 0, lamp = 1, ceiling = 2, first_of_floor = 3;
constexpr std::uint32_t tiles = 4;

/// Returns a room with a lamp under its ceiling and no floor.
Scene room_without_floor() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(100, 0), test::grey(0, 0.7)};
  test::add_polygon(scene, {{0, 3, 0}, {4, 3, 0}, {4, 3, 4}, {0, 3, 4}}, ceiling);
  test::add_polygon(scene, {{0, 0, 0}, {0, 3, 0}, {0, 3, 4}, {0, 0, 4}}, walls);
  test::add_polygon(scene, {{4, 0, 0}, {4, 0, 4}, {4, 3, 4}, {4, 3, 0}}, walls);
  test::add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {0, 3, 0}}, walls);
  test::add_polygon(scene, {{0, 0, 4}, {0, 3, 4}, {4, 3, 4}, {4, 0, 4}}, walls);
  test::add_polygon(scene, {{0.5, 2.9, 1}, {1.5, 2.9, 1}, {1.5, 2.9, 2}, {0.5, 2.9, 2}}, lamp);
  return scene;
}

ColourImage image_of_floor() {
  ColourImage image = test::noise(tiles, tiles, 5);
  for (std::size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = i / 3 % 3 == 0 ? 250 : image.texels[i] / 3;
  return image;
}

/// Returns the room with a floor of one face and a texture.
Scene room_with_texture() {
  Scene scene = room_without_floor();
  scene.materials.push_back(test::textured(image_of_floor()));
  test::add_textured(scene, {{0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}}, {{0, 0}, {0, 1}, {1, 1}, {1, 0}}, first_of_floor);
  return scene;
}

/// Returns the same room with a floor of tiles.
Scene room_with_tiles() {
  Scene scene = room_without_floor();
  const ColourImage image = image_of_floor();
  for (std::uint32_t row = 0; row < tiles; ++row)
    for (std::uint32_t column = 0; column < tiles; ++column) {
      const auto* texel = &image.texels[3 * (row * tiles + column)];
      scene.materials.push_back(
          {"tile", {}, {reflectance_of_texel(texel[0]), reflectance_of_texel(texel[1]), reflectance_of_texel(texel[2])}, false});
      const double x = column, z = row;
      test::add_polygon(scene, {{x, 0, z}, {x, 0, z + 1}, {x + 1, 0, z + 1}, {x + 1, 0, z}},
                        first_of_floor + row * tiles + column);
    }
  return scene;
}

void expect_ratio(const Rgb& a, const Rgb& b, double tolerance) {
  EXPECT_NEAR(a.r, b.r, tolerance * b.r);
  EXPECT_NEAR(a.g, b.g, tolerance * b.g);
  EXPECT_NEAR(a.b, b.b, tolerance * b.b);
}

class TexturesByStrategy : public testing::TestWithParam<Strategy> {};

TEST_P(TexturesByStrategy, LightARoomAsTilesDo) {
  SolveOptions options{.tolerance = 0.01, .strategy = GetParam()};
  const auto textured = mean_by_material(room_with_texture(), options), tiled = mean_by_material(room_with_tiles(), options);
  Rgb floor;
  for (std::size_t tile = first_of_floor; tile < tiled.size(); ++tile) floor += tiled[tile] * (1.0 / (tiles * tiles));
  constexpr double noise = 3e-3;
  expect_ratio(textured[ceiling], tiled[ceiling], noise);
  expect_ratio(textured[walls], tiled[walls], noise);
  expect_ratio(textured[first_of_floor], floor, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(All, TexturesByStrategy,
                         testing::Values(Strategy::automatic, Strategy::gather, Strategy::shoot, Strategy::sorted,
                                         Strategy::sorted_ambient, Strategy::overshoot),
                         [](const auto& strategy) { return "Strategy" + std::to_string(static_cast<int>(strategy.param)); });

// The form factor between any two parts of a sphere is the share of the sphere's area: H = E / (1 - mean rho) everywhere.
TEST(Textures, InAnIntegratingSphereCountByTheirMean) {
  Scene globe;
  test::add_globe(globe, {0, 0, 0}, 1, 3, 0);
  Scene scene;
  scene.materials = {test::textured(test::checkerboard(8, 40, 220))};
  scene.materials[0].emission = {1, 1, 1};
  std::mt19937 random(2);
  const auto place = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
  for (const Face& face : globe.faces) {
    const auto corners = globe.corners_of(face);
    test::add_textured(scene, {globe.vertices[corners[0]], globe.vertices[corners[2]], globe.vertices[corners[1]]},
                       {{place(), place()}, {place(), place()}, {place(), place()}}, 0);
  }
  const BaseMesh mesh(scene);
  const PatchReflectance reflectance(mesh);
  double reflected = 0, area = 0, irradiance = 0;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) {
    area += mesh.roots()[root].area;
    reflected += mesh.roots()[root].area * reflectance.of(shape_of(mesh, PatchId::root(root))).reflectance.mean();
  }
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 0.01}))
    irradiance += area_of(mesh, shape_of(mesh, leaf.patch)) * widen(leaf.irradiance).mean() / area;
  EXPECT_NEAR(irradiance, 1 / (1 - reflected / area), 0.005 / (1 - reflected / area));
}

// As above, with H = E / (1 - mean rho).
TEST(Colours, InAnIntegratingSphereCountByTheirMean) {
  Scene globe, scene;
  test::add_globe(globe, {0, 0, 0}, 1, 3, 0);
  scene.materials = {test::grey(1, 0.9)};
  std::mt19937 random(2);
  double reflected = 0, area = 0, irradiance = 0;
  for (const Face& face : globe.faces) {
    const auto corners = globe.corners_of(face);
    scene.add_polygon(std::array{globe.vertices[corners[0]], globe.vertices[corners[2]], globe.vertices[corners[1]]}, 0);
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
      const float colour = std::uniform_real_distribution<float>(0, 1)(random);
      scene.corner_colours.push_back({colour, colour, colour});
      sum += double{colour} / 3;
    }
    const double a = length(cross(globe.vertices[corners[1]] - globe.vertices[corners[0]],
                                  globe.vertices[corners[2]] - globe.vertices[corners[0]])) /
                     2;
    reflected += 0.9 * a * sum, area += a;
  }
  const BaseMesh mesh(scene);
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 0.01}))
    irradiance += area_of(mesh, shape_of(mesh, leaf.patch)) * widen(leaf.irradiance).mean() / area;
  EXPECT_NEAR(irradiance, 1 / (1 - reflected / area), 0.005 / (1 - reflected / area));
}

TEST(Colours, ThatAreNotGreyNeedThreeBands) {
  Scene scene = test::furnace(1, 0.5);
  scene.corner_colours.assign(scene.corners.size(), {0.5F, 0.5F, 0.5F});
  EXPECT_FALSE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
  scene.corner_colours[5].r = 0.6F;
  EXPECT_TRUE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
}

TEST(Textures, OfOneColourAreFacesOfThatColour) {
  Scene plain = test::coloured_room(), scene = plain;
  const ColourImage image{2, 2, {188, 188, 188, 188, 188, 188, 188, 188, 188, 188, 188, 188}};
  const Material textured = test::textured(image, {0.8, 0.8, 0.8});
  plain.materials[0].reflectance = textured.reflectance;
  scene.materials[0] = textured;
  test::complete_texture_points(scene);
  const auto expected = mean_by_material(plain), found = mean_by_material(scene);
  for (std::size_t m = 0; m < expected.size(); ++m) expect_ratio(found[m], expected[m], 1e-5);
}

TEST(Textures, GreyOnesNeedNoThreeBands) {
  Scene scene = test::furnace(1, 0.5);
  scene.materials[0] = test::textured(test::checkerboard(4, 10, 200));
  scene.materials[0].emission = {1, 1, 1};
  test::complete_texture_points(scene);
  EXPECT_FALSE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
  scene.materials[0].texture->image = std::make_shared<const ColourImage>(image_of_floor());
  EXPECT_TRUE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
}

TEST(Textures, PowerIsNeitherMadeNorLost) {
  const BaseMesh mesh(room_with_texture());
  SolutionLog log;
  const SolveOutcome outcome = solve(mesh, {.tolerance = 0.01}, log, {});
  const PowerBalance& balance = outcome.balance;
  EXPECT_NEAR(balance.absorbed + balance.lost + balance.unshot, balance.emitted, 0.01 * balance.emitted);
  EXPECT_LT(balance.lost, 0.01 * balance.emitted);
}

TEST(Textures, SplitLeavesUntilTheirQuartersAreAlike) {
  const BaseMesh mesh(room_with_texture());
  SolutionLog log;
  solve(mesh, {.tolerance = 0.2}, log, {});
  std::size_t leaves = 0;
  for (const LeafValue& leaf : log.leaves()) leaves += mesh.roots()[leaf.patch.root_face()].material == first_of_floor;
  EXPECT_GE(leaves, std::size_t{tiles * tiles});
}

}  // namespace
}  // namespace alvor
