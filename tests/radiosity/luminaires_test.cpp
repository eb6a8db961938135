// Luminaires, against closed forms and emissive faces.

#include "radiosity/direct/face_light.h"
#include "radiosity/direct/lights_of_scene.h"
#include "radiosity/plan/plan.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using std::numbers::pi;
using Shape = LuminousOpening::Shape;

/// Returns a web with rotational symmetry: `intensity` of the cosine of the angle from the aim.
template <class Intensity>
std::shared_ptr<const PhotometricWeb> axial_web(Intensity&& intensity) {
  auto web = std::make_shared<PhotometricWeb>();
  web->planes = {0};
  for (int degree = 0; degree <= 180; ++degree) {
    web->angles.push_back(degree);
    web->intensities.push_back(static_cast<float>(std::max(0.0, intensity(std::cos(degree * pi / 180)))));
  }
  return web;
}

/// Returns a luminaire 2 m above the floor that shines down.
Light luminaire(const LuminousOpening& opening, std::shared_ptr<const PhotometricWeb> web) {
  Light light;
  light.name = "luminaire";
  light.kind = LightKind::luminaire;
  light.intensity = {1, 1, 1};
  light.position = {0, 2, 0};
  light.direction = {0, -1, 0};
  light.across = {1, 0, 0};
  light.opening = opening;
  light.web = std::move(web);
  return light;
}

/// Returns a floor of 8 x 8 m under lights; the panel of 1.2 x 0.4 m (x by z) in the place of the luminaires shines by itself.
Scene floor_under(std::vector<Light> lights, double panel_emission) {
  Scene scene;
  scene.materials = {test::grey(0, 0), test::grey(panel_emission, 0)};
  test::add_polygon(scene, {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}});
  test::add_polygon(scene, {{-0.6, 2, -0.2}, {0.6, 2, -0.2}, {0.6, 2, 0.2}, {-0.6, 2, 0.2}}, 1);
  scene.lights = std::move(lights);
  return scene;
}

/// The light of the scene that is not a face, and its irradiance in W/m2.
class Alone {
 public:
  explicit Alone(const Scene& scene) : mesh_(scene), scene_(mesh_), unit_(mesh_), lights_(lights_beside_faces(scene_, unit_)) {}
  double irradiance(Vec3 at, Vec3 normal) const { return of(*lights_.at(0), at, normal); }
  double irradiance_of_panel(Vec3 at, Vec3 normal) const { return of(*lights_of_faces(scene_, unit_).at(0), at, normal); }

 private:
  double of(const LightSource& light, Vec3 at, Vec3 normal) const {
    return unit_.to_watts_per_m2(light.unblocked(scene_.frame().to_local(at), normal) * light.colour()).g;
  }
  BaseMesh mesh_;
  LocalScene scene_;
  EmissionUnit unit_;
  OwnedLights lights_;
};

TEST(Luminaire, WithALambertianWebIsAnAreaLampFarAwayAndCloseBy) {
  const double intensity = 100, area = 1.2 * 0.4;
  const auto web = axial_web([&](double cosine) { return intensity * cosine; });
  const Alone lights(floor_under({luminaire({Shape::rectangle, 1.2, 0.4, 0}, web)}, pi * intensity / area));
  // Points before the panel; closer than 2 cm its edges are resolved to 2 %.
  for (const double height : {-6.0, 0.0, 1.5, 1.8, 1.95})
    for (const double x : {0.0, 0.3, 0.9})
      for (const Vec3 normal : {Vec3{0, 1, 0}, normalized(Vec3{-1, 1, 0}), normalized(Vec3{0.2, 0.5, 1})}) {
        const double expected = lights.irradiance_of_panel({x, height, 0.1}, normal);
        EXPECT_NEAR(lights.irradiance({x, height, 0.1}, normal), expected, 0.02 * expected) << height << ' ' << x;
      }
}

TEST(Luminaire, OfEveryShapeHasTheIntensitiesOfItsWebFromAfar) {
  const auto web = axial_web([](double cosine) { return 50 + 30 * cosine; });
  for (const LuminousOpening& opening : {LuminousOpening{},
                                         {Shape::rectangle, 0.6, 0.3, 0},
                                         {Shape::ellipse, 0.6, 0.3, 0},
                                         {Shape::box, 0.6, 0.3, 0.2},
                                         {Shape::cylinder, 0.4, 0.4, 0.3},
                                         {Shape::sphere, 0.4, 0, 0}}) {
    const Alone light(floor_under({luminaire(opening, web)}, 0));
    for (const Vec3 way : {Vec3{0, -1, 0}, {1, -1, 0}, {0.3, -0.2, 2}, {0, 1, 0.5}}) {
      const Vec3 direction = normalized(way), at = Vec3{0, 2, 0} + 400 * direction;
      const double expected = (50 - 30 * direction.y) / 160'000;
      // The near end of the opening is up to 0.3 m closer.
      EXPECT_NEAR(light.irradiance(at, -direction), expected, 2e-3 * expected) << static_cast<int>(opening.shape);
    }
  }
}

TEST(Luminaire, TurnsItsWebWithItsAxes) {
  auto web = std::make_shared<PhotometricWeb>();
  web->angles = {0, 90, 180};
  web->planes = {0, 90, 180, 270, 360};
  web->intensities = {0, 10, 0, 0, 20, 0, 0, 30, 0, 0, 40, 0, 0, 10, 0};
  Light light = luminaire({}, web);
  // Seen from above (from behind), C goes counter-clockwise from `across`: with the aim down -y and C0 along x, C90 is along -z.
  for (const auto& [direction, expected] :
       {std::pair{Vec3{1, 0, 0}, 10.0}, {Vec3{0, 0, -1}, 20.0}, {Vec3{-1, 0, 0}, 30.0}, {Vec3{0, 0, 1}, 40.0}})
    EXPECT_NEAR(HungWeb(light).intensity(direction), expected, 1e-6);
  light.across = {0, 0, 1};
  EXPECT_NEAR(HungWeb(light).intensity({0, 0, 1}), 10, 1e-6);
  EXPECT_NEAR(HungWeb(light).intensity({1, 0, 0}), 20, 1e-6);
}

// Its photometric centre lies above the ceiling, its lower face below.
TEST(Luminaire, HalfRecessedInACeilingLightsTheRoom) {
  Scene room;
  room.materials = {test::grey(0, 0.5)};
  test::add_box(room, {-2, 0, -2}, {2, 1.98, 2}, true);
  room.lights = {luminaire({Shape::box, 0.3, 0.3, 0.1}, axial_web([](double cosine) { return cosine; }))};
  EXPECT_TRUE(Plan(BaseMesh(room), {}).may_be_lit(0));
  room.lights[0].opening.height = 0.01;
  room.lights[0].opening.across = room.lights[0].opening.along = 0.01;
  EXPECT_FALSE(Plan(BaseMesh(room), {}).may_be_lit(0));
}

TEST(Luminaire, FaultsAreTold) {
  const auto web = axial_web([](double) { return 1.0; });
  Light light = luminaire({Shape::rectangle, 0.6, 0, 0}, web);
  EXPECT_EQ(fault_in(light), "its opening has no area");
  light.opening = {};
  light.across = light.direction;
  EXPECT_EQ(fault_in(light), "its axis across is not a unit vector perpendicular to its direction");
  light.across = {1, 0, 0};
  EXPECT_EQ(fault_in(light), std::nullopt);
  light.web = nullptr;
  EXPECT_EQ(fault_in(light), "it has no photometric web");
  auto bad = std::make_shared<PhotometricWeb>(*web);
  bad->intensities[3] = std::nanf("");
  light.web = bad;
  EXPECT_TRUE(fault_in(light));
  for (const double angle : {std::nan(""), 0.0, 1e-300}) {
    auto crooked = std::make_shared<PhotometricWeb>(*web);
    crooked->angles[1] = angle;
    light.web = crooked;
    EXPECT_EQ(fault_in(light), "the angles of its photometric web do not ascend") << angle;
  }
  light.web = web;
  light.opening = {Shape::rectangle, 1e-170, 1e-170, 0};
  EXPECT_TRUE(fault_in(light));
}

}  // namespace
}  // namespace alvor
