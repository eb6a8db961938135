#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace alvor {
namespace {

std::string fault_after(const std::function<void(Scene&)>& spoil) {
  Scene scene = test::furnace(1, 0.5);
  spoil(scene);
  const auto fault = find_fault(scene);
  return fault ? fault->text() : "";
}

TEST(Scene, AGoodOneHasNoFault) {
  EXPECT_EQ(fault_after([](Scene&) {}), "");
}

TEST(Scene, FaultsNameThePlaceAndTheReason) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fault_after([](Scene& s) { s.faces.clear(); }), "scene: has no faces");
  EXPECT_EQ(fault_after([](Scene& s) { s.vertices[5].y = nan; }), "vertex 5: coordinate nan is not finite");
  EXPECT_EQ(fault_after([](Scene& s) { s.vertices[5].y = 2e9; }), "vertex 5: coordinate 2e+09 is beyond 1e9 m");
  EXPECT_EQ(fault_after([](Scene& s) { s.corners[9] = 24; }), "face 2: vertex index 24 is out of range, there are 24 vertices");
  EXPECT_EQ(fault_after([](Scene& s) { s.faces[3].material = 1; }),
            "face 3: material index 1 is out of range, there are 1 materials");
  EXPECT_EQ(fault_after([](Scene& s) { s.faces[3].corner_count = 2; }), "face 3: has 2 corners, needs at least 3");
  EXPECT_EQ(fault_after([](Scene& s) { s.faces[3].corner_count = ~0u; }), "face 3: its corners end beyond the list of corners");
  EXPECT_EQ(fault_after([](Scene& s) { s.materials[0].reflectance.g = 1; }),
            "material 0 'grey': reflectance 1 is outside [0, 1)");
  EXPECT_EQ(fault_after([](Scene& s) { s.materials[0].reflectance.g = nan; }),
            "material 0 'grey': reflectance nan is outside [0, 1)");
  EXPECT_EQ(fault_after([](Scene& s) { s.materials[0].emission.b = -1; }),
            "material 0 'grey': emission -1 is not a finite value >= 0");
  EXPECT_EQ(fault_after([](Scene& s) { s.materials[0].emission.b = 1e31; }),
            "material 0 'grey': emission 1e+31 is beyond 1e30 W/m2");
}

TEST(Scene, ObjectsThatDoNotFitAreFaultsByName) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fault_of = [](const std::function<void(std::vector<SceneObject>&)>& spoil) {
    return fault_after([&](Scene& scene) {
      scene.objects = {{"room", std::nullopt, {}, 0, 0}, {"floor", 0, {}, 0, 2}, {"walls", 0, {}, 3, 3}};
      spoil(scene.objects);
    });
  };
  EXPECT_EQ(fault_of([](auto&) {}), "");
  EXPECT_EQ(fault_of([](auto& o) { o[1].name.clear(); }), "object 1 '': has no name");
  EXPECT_EQ(fault_of([](auto& o) { o[2].name = "floor"; }), "object 2 'floor': has the name of another object");
  EXPECT_EQ(fault_of([](auto& o) { o[1].parent = 1; }), "object 1 'floor': its parent 1 does not come before it");
  EXPECT_EQ(fault_of([](auto& o) { o[1].placement.x.y = nan; }),
            "object 1 'floor': its transform has a number that is not finite");
  EXPECT_EQ(fault_of([](auto& o) { o[2].face_count = 4; }), "object 2 'walls': its faces end beyond the 6 faces of the scene");
  EXPECT_EQ(fault_of([](auto& o) { o[2].first_face = ~0u; }), "object 2 'walls': its faces end beyond the 6 faces of the scene");
  EXPECT_EQ(fault_of([](auto& o) { o[1].face_count = 4; }),
            "object 2 'walls': its faces begin before those of the object before it end");
}

TEST(Scene, FaultsOfLightsNameThem) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fault_of = [](const std::function<void(Light&)>& spoil) {
    return fault_after([&](Scene& scene) {
      scene.lights = {Light{"bulb", LightKind::point, {1, 1, 1}}, Light{"spot", LightKind::spot, {1, 1, 1}}};
      spoil(scene.lights[1]);
    });
  };
  EXPECT_EQ(fault_of([](Light&) {}), "");
  EXPECT_EQ(fault_of([](Light& l) { l.intensity.g = -1; }), "light 1 'spot': intensity -1 is outside [0, 1e30]");
  EXPECT_EQ(fault_of([](Light& l) { l.intensity.g = nan; }), "light 1 'spot': intensity nan is outside [0, 1e30]");
  EXPECT_EQ(fault_of([](Light& l) { l.position.x = nan; }), "light 1 'spot': coordinate nan is not within 1e9 m");
  EXPECT_EQ(fault_of([](Light& l) { l.direction = {}; }), "light 1 'spot': its direction is not a unit vector");
  EXPECT_EQ(fault_of([](Light& l) { l.radius = -1; }), "light 1 'spot': radius -1 is outside [0, 1e9] m");
  EXPECT_EQ(fault_of([](Light& l) { l.outer_cone = 0; }), "light 1 'spot': outer cone angle 0 is outside (0, pi]");
  EXPECT_EQ(fault_of([](Light& l) { l.inner_cone = 2; }), "light 1 'spot': inner cone angle 2 is outside [0, outer cone angle]");
  EXPECT_EQ(fault_of([](Light& l) { l.angular_diameter = 2; }), "light 1 'spot': angular diameter 2 is outside [0, pi / 2]");
  EXPECT_EQ(fault_after([](Scene& s) {
              s.lights.assign(65, Light{"sun", LightKind::directional, {1, 1, 1}});
            }),
            "scene: has 65 distant lights (an environment counts as three), at most 64 are possible");
}

}  // namespace
}  // namespace alvor
