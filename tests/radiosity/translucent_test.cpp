// Faces that scatter light behind them, against closed forms.

#include "radiosity/plan/plan.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"
#include "tests/textures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using test::Solved;

Material sheet(double reflectance, double transmittance, double emission = 0) {
  Material material = test::grey(emission, reflectance);
  material.name = "sheet";
  material.two_sided = true;
  material.diffuse_transmittance = {transmittance, transmittance, transmittance};
  return material;
}

// A sheet is as bright as the walls of a furnace if it emits what it absorbs: E = B (1 - rho - tau).
TEST(Translucent, SheetsThatEmitWhatTheyAbsorbChangeNothingInAFurnace) {
  for (const auto& [reflectance, transmittance] : {std::pair{0.3, 0.4}, {0.0, 0.9}, {0.0, 0.2}, {0.6, 0.0}}) {
    Scene scene = test::furnace(1, 0.5);
    scene.materials.push_back(sheet(reflectance, transmittance, 2 * (1 - reflectance - transmittance)));
    test::add_polygon(scene, {{1, 0.2, 0.5}, {1, 1.8, 0.5}, {1.3, 1.8, 3.5}, {1.3, 0.2, 3.5}}, 1);
    test::add_polygon(scene, {{2, 0.2, 0.5}, {2, 1.8, 0.5}, {2.2, 1.8, 3.5}}, 1);
    const Solved solved(scene, {.tolerance = 0.01});
    for (std::uint32_t face = 0; face < scene.faces.size(); ++face)
      EXPECT_NEAR(solved.of_face(face).g, 2, 0.02) << face << ' ' << reflectance;
  }
}

constexpr std::uint32_t walls = 0, far_walls = 1, screen = 2;

/// Returns a room of 4 x 3 x 4 m whose wall x high is of another material.
Scene half_room(double emission, const Material& wall) {
  Scene scene;
  scene.materials = {test::grey(emission, 0.5), wall};
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true, {0, 0, 0, 1, 0, 0});
  return scene;
}

/// Returns two such rooms side by side with a sheet between them; the walls of the first emit.
Scene two_rooms(const Material& between) {
  Scene scene;
  scene.materials = {test::grey(1, 0.5), test::grey(0, 0.5), between};
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true, {walls, walls, walls, screen, walls, walls});
  test::add_box(scene, {4, 0, 0}, {8, 3, 4}, true, {far_walls, far_walls, screen, far_walls, far_walls, far_walls});
  scene.faces.erase(scene.faces.begin() + 8);  // the second screen in the same place
  return scene;
}

// The light of two rooms, of which one shines, is the mean of that if both shine, where the screen is a wall of reflectance rho +
// tau, and of that if one shines and the other takes as much away, where it is a wall of rho - tau.
TEST(Translucent, ScreensBetweenTwoRoomsShareTheLightAsByHand) {
  const double reflectance = 0.4, transmittance = 0.3;
  const SolveOptions exact{.tolerance = 0.005, .seed = 3};
  const Solved even(half_room(1, test::grey(0, reflectance + transmittance)), exact),
      odd(half_room(1, test::grey(0, reflectance - transmittance)), exact);
  for (const Strategy strategy :
       {Strategy::automatic, Strategy::gather, Strategy::shoot, Strategy::sorted, Strategy::overshoot}) {
    SCOPED_TRACE(text(strategy));
    const Solved solved(two_rooms(sheet(reflectance, transmittance)), {.tolerance = 0.01, .strategy = strategy});
    for (const std::uint32_t face : {0u, 2u, 4u}) {  // floor, back wall, side wall
      const double both = even.of_face(face).g, difference = odd.of_face(face).g;
      EXPECT_NEAR(solved.of_face(face).g, (both + difference) / 2, 0.01 * both) << face;
    }
    const double behind = (even.of_face(2).g - odd.of_face(2).g) / 2;
    EXPECT_NEAR(solved.of_face(8).g, behind, 0.03 * behind) << "the wall opposite the screen in the dark room";
    EXPECT_NEAR(solved.outcome().balance.gap(), 0, 0.01);
    EXPECT_NEAR(solved.outcome().balance.lost, 0, 0.01 * solved.outcome().balance.emitted);
  }
}

/// Returns a black floor, face 0, under a screen, and a spot light that shines on the screen from above or from below.
Scene screen_over_floor(const Material& material, bool from_above) {
  Scene scene;
  scene.materials = {test::grey(0, 0), material};
  test::add_polygon(scene, {{-2, 0, -2}, {-2, 0, 2}, {2, 0, 2}, {2, 0, -2}});
  test::add_polygon(scene, {{-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}}, 1);
  Light spot;
  spot.name = "spot", spot.kind = LightKind::spot, spot.position = {0.2, from_above ? 1.8 : 0.2, 0.1};
  spot.direction = {0, from_above ? -1.0 : 1.0, 0}, spot.intensity = {10, 10, 10};
  spot.inner_cone = 0.5, spot.outer_cone = 0.7;
  scene.lights = {spot};
  return scene;
}

// A translucent screen lit from above sends down as much light as a reflecting screen lit from below.
TEST(Translucent, ScreensLetAsMuchThroughAsAsDiffuseOnesReflect) {
  const SolveOptions options{.tolerance = 0.01};
  const double through = Solved(screen_over_floor(sheet(0, 0.4), true), options).of_face(0).g,
               back = Solved(screen_over_floor(sheet(0.4, 0), false), options).of_face(0).g;
  EXPECT_GT(back, 0.01);
  EXPECT_NEAR(through, back, 0.01 * back);
}

TEST(Translucent, FacesThatLetNothingThroughAreOpaque) {
  const SolveOptions options{.tolerance = 0.05};
  Scene scene = two_rooms(sheet(0.4, 0));
  EXPECT_EQ(Solved(scene, options).of_face(8).g, 0);
  scene.materials[screen].diffuse_transmittance = {0.1, 0, 0};
  const Rgb behind = Solved(scene, options).of_face(8);
  EXPECT_GT(behind.r, 0.01);
  EXPECT_LT(behind.g, 1e-3 * behind.r) << "a ray may slip through a seam";
}

TEST(Translucent, SidesHaveTheSameLeaves) {
  Scene scene = test::coloured_room();
  scene.materials.push_back(sheet(0.3, 0.4));
  test::add_polygon(scene, {{0.5, 2, 0.5}, {3.5, 2, 0.5}, {3.5, 1.6, 4.5}, {0.5, 1.6, 4.5}}, 3);
  test::add_polygon(scene, {{0.3, 0.5, 0.5}, {0.3, 2.5, 0.5}, {0.3, 0.5, 4}}, 3);
  const BaseMesh mesh(scene);
  std::vector<PatchId> ids;
  for (const LeafValue& leaf : test::solved(mesh, {.tolerance = 0.02, .max_leaves = 1500})) ids.push_back(leaf.patch);
  std::size_t pairs = 0;
  for (const PatchId id : ids) {
    if (!mesh.is_translucent(id.root_face())) continue;
    ++pairs;
    EXPECT_TRUE(std::ranges::binary_search(ids, twin_of(mesh, id)));
    EXPECT_LT(length(centre_of(mesh, shape_of(mesh, id)) - centre_of(mesh, shape_of(mesh, twin_of(mesh, id)))), 1e-12);
    EXPECT_EQ(twin_of(mesh, twin_of(mesh, id)), id);
  }
  EXPECT_GT(pairs, 16u);
}

TEST(Translucent, SheetsKeepThePowerBalance) {
  Scene scene = test::coloured_room();
  scene.materials.push_back(sheet(0.3, 0.4));
  scene.materials.back().diffuse_transmittance = {0.6, 0.3, 0};
  test::add_polygon(scene, {{0, 2, 0}, {4, 2, 0}, {4, 1.6, 5}, {0, 1.6, 5}}, 3);
  const PowerBalance balance = Solved(scene, {.tolerance = 0.02}).outcome().balance;
  EXPECT_NEAR(balance.gap(), 0, 0.01);
  EXPECT_NEAR(balance.lost, 0, 0.01 * balance.emitted);
}

TEST(Translucent, FacesLetLightIntoARoomThatTheyClose) {
  Scene scene = test::furnace(0, 0.5);
  scene.materials.push_back(sheet(0.3, 0.4));
  test::add_box(scene, {1, 0.5, 1}, {2, 1, 2}, true, {0, 0, 1, 0, 0, 0});  // a room in the room, one of its walls a sheet
  Light lamp;
  lamp.name = "lamp", lamp.kind = LightKind::point, lamp.position = {0.5, 0.75, 1.5}, lamp.intensity = {1, 1, 1};
  scene.lights = {lamp};
  EXPECT_GT(Solved(scene).of_face(9).g, 0.005);  // the wall opposite the sheet
}

TEST(Translucent, MaterialsThatMakeLightAreRefused) {
  const auto refused = [](const Material& material) {
    Scene scene = half_room(1, material);
    const auto fault = find_fault(scene);
    return fault ? fault->text() : "";
  };
  EXPECT_EQ(refused(sheet(0.5, 0.5)),
            "material 1 'sheet': reflectance and diffuse transmittance are 1 together, must be below 1");
  EXPECT_EQ(refused(sheet(0, 1)), "material 1 'sheet': diffuse transmittance 1 is outside [0, 1)");
  EXPECT_EQ(refused(sheet(0, -0.1)), "material 1 'sheet': diffuse transmittance -0.1 is outside [0, 1)");
  EXPECT_EQ(refused(sheet(0, std::nan(""))), "material 1 'sheet': diffuse transmittance nan is outside [0, 1)");
  Material one_sided = sheet(0.3, 0.3);
  one_sided.two_sided = false;
  EXPECT_EQ(refused(one_sided), "material 1 'sheet': diffuse transmittance needs two sides");
  Material glass = sheet(0.3, 0.3);
  glass.regular_transmittance = {0.5, 0.5, 0.5};
  EXPECT_EQ(refused(glass), "material 1 'sheet': reflectance and transmittance are 1.1 together, beyond 1");
  EXPECT_EQ(refused(sheet(0.3, 0.3)), "");
}

TEST(Translucent, DarkTexturesLeaveRoomForWhatComesThrough) {
  Scene scene = half_room(1, test::textured(test::checkerboard(4, 10, 100)));
  test::complete_texture_points(scene);
  Material& wall = scene.materials[1];
  wall.two_sided = true;
  wall.diffuse_transmittance = {0.8, 0.8, 0.8};
  EXPECT_TRUE(find_fault(scene)) << "its largest texel is not known";
  ColourImage image = *wall.texture->image;
  find_most(image);
  wall.texture->image = std::make_shared<const ColourImage>(std::move(image));
  EXPECT_FALSE(find_fault(scene));
  EXPECT_NEAR(wall.largest_reflectance().g, reflectance_of_texel(100), 1e-12);
}

TEST(Translucent, ColoursAreKnownToThePlan) {
  Scene scene = half_room(1, sheet(0.3, 0.3));
  EXPECT_FALSE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
  EXPECT_FALSE(Plan(BaseMesh(scene), {}).needs(Feature::panes));
  scene.materials[1].diffuse_transmittance = {0.3, 0.2, 0.3};
  EXPECT_TRUE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
}

}  // namespace
}  // namespace alvor
