// Faces that light goes straight through, against closed forms.

#include "meshing/patch_place.h"
#include "radiosity/plan/plan.h"
#include "tests/environments.h"
#include "tests/radiosity/solved.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {
namespace {

Material pane(const Rgb& transmittance, const Rgb& reflectance = {}, bool two_sided = false) {
  return {"pane", {}, reflectance, two_sided, transmittance};
}

using test::Solved;

/// Returns a black floor of 1 m, face 0, below a point lamp at 4 m.
Scene floor_under_lamp() {
  Scene scene;
  scene.materials = {test::grey(0, 0)};
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}});
  Light lamp;
  lamp.name = "lamp", lamp.kind = LightKind::point, lamp.position = {0.5, 4, 0.5}, lamp.intensity = {10, 10, 10};
  scene.lights = {lamp};
  return scene;
}

/// Share by which the mean over the floor differs between meshes of other leaves.
constexpr double leaves_differ = 5e-4;

void add_pane(Scene& scene, double height, const Material& material, bool faces_down = false) {
  const auto number = static_cast<std::uint32_t>(scene.materials.size());
  scene.materials.push_back(material);
  const double y = height;
  if (faces_down) test::add_polygon(scene, {{-3, y, -3}, {4, y, -3}, {4, y, 4}, {-3, y, 4}}, number);
  else test::add_polygon(scene, {{-3, y, -3}, {-3, y, 4}, {4, y, 4}, {4, y, -3}}, number);
}

TEST(Panes, DimByTheirTransmittanceFromEitherSide) {
  const Rgb clear = Solved(floor_under_lamp()).of_face(0);
  const Rgb tint{0.8, 0.5, 0.1};
  for (const bool two_sided : {false, true})
    for (const bool faces_down : {false, true}) {
      Scene scene = floor_under_lamp();
      add_pane(scene, 2, pane(tint, {}, two_sided), faces_down);
      const Rgb dimmed = Solved(scene).of_face(0);
      EXPECT_NEAR(dimmed.r, 0.8 * clear.r, leaves_differ * clear.r);
      EXPECT_NEAR(dimmed.g, 0.5 * clear.g, leaves_differ * clear.g);
      EXPECT_NEAR(dimmed.b, 0.1 * clear.b, leaves_differ * clear.b);
    }
}

TEST(Panes, BehindEachOtherDimByTheirProduct) {
  const double clear = Solved(floor_under_lamp()).of_face(0).r;
  Scene scene = floor_under_lamp();
  for (const double height : {1.0, 1.5, 3.0}) add_pane(scene, height, pane({0.7, 0.7, 0.7}));
  EXPECT_NEAR(Solved(scene).of_face(0).r, 0.343 * clear, leaves_differ * clear);
}

TEST(Panes, BehindALampOrASurfaceDimNothing) {
  const double clear = Solved(floor_under_lamp()).of_face(0).r;
  Scene scene = floor_under_lamp();
  add_pane(scene, 5, pane({0.2, 0.2, 0.2}));
  add_pane(scene, -1, pane({0.2, 0.2, 0.2}));
  EXPECT_NEAR(Solved(scene, {.tolerance = 0.05}).of_face(0).r, clear, leaves_differ * clear);
}

/// Returns a room of reflectance 0.5 under a uniform sky, whose wall z low has a window, the last face. Face 0 is the floor.
Scene room_with_window(const Material& window) {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), window};
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  scene.faces.erase(scene.faces.begin() + 4);
  test::add_polygon(scene, {{0, 0, 0}, {4, 0, 0}, {4, 1, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{0, 1, 0}, {4, 1, 0}, {4, 3, 0}, {0, 3, 0}}, 1);
  scene.lights = {test::environment({16, 8}, [](Vec3) { return Rgb{1, 1, 1}; })};
  return scene;
}

TEST(Panes, InAWindowDimDaylightAndAllThatComesOfIt) {
  const SolveOptions options{.tolerance = 0.01, .seed = 3};
  Scene open = room_with_window(pane({1, 1, 1}));
  open.faces.pop_back();
  const double without = Solved(open, options).of_face(0).r,
               clear = Solved(room_with_window(pane({1, 1, 1})), options).of_face(0).r,
               tinted = Solved(room_with_window(pane({0.8, 0.8, 0.8})), options).of_face(0).r;
  EXPECT_NEAR(clear, without, 0.01 * without);
  EXPECT_NEAR(tinted, 0.8 * without, 0.01 * without);
}

// All surfaces of a furnace are equally bright. A pane that absorbs nothing reflects exactly as much light as it keeps from going
// through, so it changes nothing between them: everywhere H = E / (1 - rho).
TEST(Panes, ThatAbsorbNothingChangeNothingInAFurnace) {
  for (const double reflectance : {0.0, 0.3, 0.7}) {
    Scene scene = test::furnace(1, 0.5);
    scene.materials.push_back(
        pane({1 - reflectance, 1 - reflectance, 1 - reflectance}, {reflectance, reflectance, reflectance}, true));
    test::add_polygon(scene, {{1, 0.2, 0.5}, {1, 1.8, 0.5}, {1.3, 1.8, 3.5}, {1.3, 0.2, 3.5}}, 1);
    test::add_polygon(scene, {{2, 0.2, 0.5}, {2, 1.8, 0.5}, {2, 1.8, 3.5}, {2, 0.2, 3.5}}, 1);
    const Solved solved(scene, {.tolerance = 0.01});
    for (std::uint32_t face = 0; face < scene.faces.size(); ++face)
      EXPECT_NEAR(solved.of_face(face).g, 2, 0.02) << face << ' ' << reflectance;
  }
}

TEST(Panes, InStacksLoseNothing) {
  Scene scene = test::furnace(1, 0.5);
  scene.materials.push_back(pane({0.94, 0.94, 0.94}, {0.06, 0.06, 0.06}, true));
  for (int n = 0; n < 30; ++n) {
    const double x = 0.8 + 0.05 * n;
    test::add_polygon(scene, {{x, 0.1, 0.2}, {x, 1.9, 0.2}, {x, 1.9, 3.8}, {x, 0.1, 3.8}}, 1);
  }
  const Solved solved(scene, {.tolerance = 0.02, .max_depth = 1});
  for (std::uint32_t face = 0; face < 6; ++face) EXPECT_NEAR(solved.of_face(face).g, 2, 0.04) << face;
  EXPECT_NEAR(solved.outcome().balance.gap(), 0, 0.02);
}

TEST(Panes, KeepThePowerBalance) {
  for (const bool two_sided : {false, true}) {
    Scene scene = test::coloured_room();
    scene.materials.push_back(pane({0.5, 0.3, 0.2}, {0.3, 0.3, 0.5}, two_sided));
    test::add_polygon(scene, {{0, 2, 0}, {4, 2, 0}, {4, 1.6, 5}, {0, 1.6, 5}}, 3);
    const PowerBalance balance = Solved(scene, {.tolerance = 0.02}).outcome().balance;
    EXPECT_NEAR(balance.gap(), 0, 0.01) << two_sided;
    // In a closed room only the black back of a one-sided pane loses light.
    if (two_sided) EXPECT_NEAR(balance.lost, 0, 0.01 * balance.emitted);
    else EXPECT_GT(balance.lost, 0.05 * balance.emitted);
  }
}

TEST(Panes, AreKnownToThePlan) {
  Scene scene = floor_under_lamp();
  EXPECT_FALSE(Plan(BaseMesh(scene), {}).needs(Feature::panes));
  add_pane(scene, 2, pane({0.5, 0.5, 0.5}));
  EXPECT_TRUE(Plan(BaseMesh(scene), {}).needs(Feature::panes));
  EXPECT_FALSE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
  scene.materials.back() = pane({0.5, 0.4, 0.5});
  EXPECT_TRUE(Plan(BaseMesh(scene), {}).needs(Feature::three_bands));
}

TEST(Panes, LetLightIntoARoomThatIsClosedByThem) {
  Scene scene = test::furnace(0, 0.5);
  test::add_box(scene, {1, 0.5, 1}, {2, 1, 2}, true, {0, 0, 1, 0, 0, 0});  // a room in the room, one of its walls a pane
  scene.materials.push_back(pane({0.9, 0.9, 0.9}));
  Light lamp;
  lamp.name = "lamp", lamp.kind = LightKind::point, lamp.position = {0.5, 0.75, 1.5}, lamp.intensity = {1, 1, 1};
  scene.lights = {lamp};
  const Solved solved(scene);
  EXPECT_GT(solved.of_face(9).g, 0.01);  // the wall opposite the pane
}

TEST(Panes, ThatMakeLightAreRefused) {
  const auto refused = [](const Material& material) {
    Scene scene = floor_under_lamp();
    add_pane(scene, 2, material);
    const auto fault = find_fault(scene);
    return fault ? fault->text() : "";
  };
  EXPECT_EQ(refused(pane({0.6, 0.5, 0.5}, {0.5, 0.5, 0.5})),
            "material 1 'pane': reflectance and transmittance are 1.1 together, beyond 1");
  EXPECT_EQ(refused(pane({0.5, -0.1, 0.5})), "material 1 'pane': regular transmittance -0.1 is outside [0, 1]");
  EXPECT_EQ(refused(pane({0.5, 0.5, std::nan("")})), "material 1 'pane': regular transmittance nan is outside [0, 1]");
  EXPECT_EQ(refused(pane({1, 1, 1})), "");
}

}  // namespace
}  // namespace alvor
