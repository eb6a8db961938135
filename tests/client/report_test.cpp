// Tests of the report: rooms, grids, illuminance, glare, daylight factors, and what is written.

#include "client/report/report.h"
#include "client/report/position_index.h"
#include "meshing/display_mesh.h"
#include "radiosity/solve/solver.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace alvor {
namespace {

using std::numbers::pi;

/// Returns a solution in which every surface receives the same light.
DisplayMesh evenly_lit(const Scene& scene, float irradiance) {
  const BaseMesh mesh(scene);
  std::vector<LeafValue> leaves;
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root)
    leaves.push_back({PatchId::root(root), {irradiance, irradiance, irradiance}});
  return build_display_mesh(mesh, leaves);
}

DisplayMesh solution_of(const Scene& scene, double tolerance) {
  const BaseMesh mesh(scene);
  SolutionLog log;
  SolveOptions options;
  options.tolerance = tolerance;
  solve(mesh, options, log, {});
  return build_display_mesh(mesh, log.leaves());
}

Scene scene_of(double emission, double reflectance, Quantity quantity = Quantity::photometric) {
  Scene scene;
  scene.materials = {test::grey(emission, reflectance)};
  scene.quantity = quantity;
  return scene;
}

/// Returns the report of the rooms that are found in a solution.
Report report_of(const DisplayMesh& mesh, const ReportOptions& options,
                 const std::optional<DaylightSolution>& overcast = std::nullopt) {
  return make_report(mesh, find_rooms(mesh, options), options, overcast);
}

Scene turned(Scene scene, double degrees) {
  const double c = std::cos(degrees * pi / 180), s = std::sin(degrees * pi / 180);
  for (Vec3& v : scene.vertices) v = {c * v.x + s * v.z, v.y, c * v.z - s * v.x};
  return scene;
}

/// Turns a scene whose y axis points up into one whose z axis does.
Scene with_z_up(Scene scene) {
  for (Vec3& v : scene.vertices) v = {v.x, -v.z, v.y};
  scene.up = UpAxis::z;
  return scene;
}

/// Returns two rooms of 4 x 3 m side by side, 2.5 m high, with a wall of 10 cm between them and a door 0.9 m wide and 2 m high.
Scene two_rooms() {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {8.1, 2.5, 3}, true);
  test::add_box(scene, {4, 0, 0}, {4.1, 2.5, 1}, false);
  test::add_box(scene, {4, 0, 1.9}, {4.1, 2.5, 3}, false);
  test::add_box(scene, {4, 2, 1}, {4.1, 2.5, 1.9}, false);
  return scene;
}

TEST(GridSpacing, IsThatOfTheStandard) {
  // EN 12464-1: p = 0.2 * 5^log10(d).
  EXPECT_NEAR(largest_spacing(1, 1), 0.2, 1e-12);
  EXPECT_NEAR(largest_spacing(10, 6), 1, 1e-12);
  EXPECT_NEAR(largest_spacing(100, 60), 5, 1e-12);
  EXPECT_NEAR(largest_spacing(10, 1), 0.2, 1e-12) << "of a long area the shorter side counts";
  EXPECT_EQ(largest_spacing(1e6, 1e6), 10);
}

TEST(Rooms, OfABoxIsItsFloorWithoutAStripAlongTheWalls) {
  Scene box = scene_of(1, 0.5);
  test::add_box(box, {1, 0, 2}, {7, 2.8, 7}, true);
  for (const Scene& scene : {box, turned(box, 31), with_z_up(box)}) {
    const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
    ASSERT_EQ(rooms.size(), 1u);
    EXPECT_NEAR(rooms[0].area, 30, 0.05);
    EXPECT_NEAR(rooms[0].clear_height, 2.8, 0.002);
    EXPECT_NEAR(std::max(rooms[0].length, rooms[0].width), 5, 0.05);
    EXPECT_NEAR(std::min(rooms[0].length, rooms[0].width), 4, 0.05);
    const WorkGrid grid = work_grid(rooms[0], std::nullopt);
    EXPECT_EQ(grid.points.size(), 63u);  // 0.616 m at most: 9 x 7
    EXPECT_LE(std::max(grid.spacing_u, grid.spacing_v), largest_spacing(5, 4));
  }
}

TEST(Rooms, AreDividedAtDoors) {
  for (const Scene& scene : {two_rooms(), turned(two_rooms(), 20)}) {
    const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
    ASSERT_EQ(rooms.size(), 2u);
    for (const Room& room : rooms) EXPECT_NEAR(room.area, 12.05, 0.2);
    EXPECT_NE(rooms[0].name, rooms[1].name);
  }
}

TEST(Rooms, AreNotTheTopsOfTables) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {6, 2.8, 5}, true);
  test::add_box(scene, {1, 0.7, 1}, {3, 0.74, 2}, false);
  test::add_box(scene, {4, 0, 3}, {5, 0.9, 4.5}, false);
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 30, 0.05);
  EXPECT_NEAR(rooms[0].clear_height, 2.8, 0.002);
}

TEST(Rooms, OfTwoStoreysAreTwo) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {4, 2.5, 4}, true);
  test::add_box(scene, {0, 2.8, 0}, {4, 5.3, 4}, true);
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_NEAR(rooms[1].floor_height - rooms[0].floor_height, 2.8, 1e-6);
}

TEST(Rooms, HaveNoStripAroundPillars) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {6, 2.8, 6}, true);
  test::add_box(scene, {2.8, 0, 2.8}, {3.2, 2.8, 3.2}, false);
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 36 - 0.16, 0.1);
  EXPECT_EQ(rooms[0].cell_at(3, -3), Room::Cell::elsewhere);
  EXPECT_EQ(rooms[0].cell_at(3.3, -3), Room::Cell::inner);
}

TEST(Rooms, AreNotDividedByAScreen) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {4, 3, 5}, true);
  test::add_polygon(scene, {{1, 0.5, 1}, {3, 0.5, 1}, {3, 2, 1}, {1, 2, 1}});  // seen from behind, it has no front
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 20, 0.05);
}

TEST(Rooms, HaveTheHeightOfTheirOwnFloor) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {5, 3, 4}, true);
  test::add_box(scene, {5.2, 0.1, 0}, {9.2, 3, 4}, true);
  test::add_polygon(scene, {{-50, -0.04, -50}, {-50, -0.04, 50}, {50, -0.04, 50}, {50, -0.04, -50}});  // the ground outside
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_NEAR(rooms[0].area, 20, 0.3);
  EXPECT_NEAR(rooms[1].area, 16, 0.3);
  EXPECT_NEAR(rooms[0].floor_height, 0, 1e-3);
  EXPECT_NEAR(rooms[1].floor_height, 0.1, 1e-3);
}

TEST(Rooms, OnLargeGroundAreAsFineAsAlone) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {5, 3, 4}, true);
  test::add_polygon(scene, {{-2000, -0.1, -2000}, {-2000, -0.1, 2000}, {2000, -0.1, 2000}, {2000, -0.1, -2000}});
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 20, 0.1);
}

TEST(Rooms, ThatAreBentAreCoveredByTheirGrid) {
  Scene scene = scene_of(1, 0.5);
  // A corridor 1.2 m wide with two legs of 10 m.
  const std::array<Vec3, 6> outline{{{0, 0, 0}, {0, 0, 10}, {1.2, 0, 10}, {1.2, 0, 1.2}, {10, 0, 1.2}, {10, 0, 0}}};
  scene.add_polygon(outline, 0);
  std::array<Vec3, 6> ceiling = outline;
  std::ranges::reverse(ceiling);
  for (Vec3& corner : ceiling) corner.y = 2.5;
  scene.add_polygon(ceiling, 0);
  for (std::size_t n = 0; n < 6; ++n) {
    const Vec3 a = outline[n], b = outline[(n + 1) % 6], up{0, 2.5, 0};
    test::add_polygon(scene, {b, a, a + up, b + up});
  }
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 22.56, 0.2);
  EXPECT_NEAR(rooms[0].local_width, 1.3, 0.15);
  const WorkGrid grid = work_grid(rooms[0], std::nullopt);
  for (double way = 0.6; way < 9.4; way += 0.4)
    for (const auto& place : {std::array{way, -0.6}, std::array{0.6, -way}})
      EXPECT_TRUE(std::ranges::any_of(
          grid.points,
          [&](const WorkPoint& point) { return std::hypot(point.along_u - place[0], point.along_v - place[1]) < 0.4; }))
          << place[0] << ' ' << place[1];
}

TEST(Rooms, HoldALampOnceEvenUnderAGallery) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {10, 6, 8}, true);
  test::add_box(scene, {6, 2.8, 0}, {10, 3, 8}, false);
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_EQ(room_at(rooms, {8, 5.9, 4}), 1u);
  EXPECT_EQ(room_at(rooms, {8, 2.7, 4}), 0u);
  EXPECT_EQ(room_at(rooms, {3, 5.9, 4}), 0u);
  EXPECT_FALSE(room_at(rooms, {20, 2, 4}));
}

TEST(Rooms, ReachUnderASlopingRoof) {
  Scene scene = scene_of(1, 0.5);
  // 6 x 5 m; the roof rises from 1 m to 3 m.
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 5}, {6, 0, 5}, {6, 0, 0}});
  test::add_polygon(scene, {{0, 1, 0}, {6, 3, 0}, {6, 3, 5}, {0, 1, 5}});
  test::add_polygon(scene, {{0, 0, 0}, {0, 1, 0}, {0, 1, 5}, {0, 0, 5}});
  test::add_polygon(scene, {{6, 0, 0}, {6, 0, 5}, {6, 3, 5}, {6, 3, 0}});
  test::add_polygon(scene, {{0, 0, 0}, {6, 0, 0}, {6, 3, 0}, {0, 1, 0}});
  test::add_polygon(scene, {{0, 0, 5}, {0, 1, 5}, {6, 3, 5}, {6, 0, 5}});
  const auto rooms = rooms_of(evenly_lit(scene, 1), 0.5);
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 30, 0.5);
}

TEST(Rooms, NeedAFloor) {
  Scene scene = scene_of(1, 0.5);
  test::add_polygon(scene, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  EXPECT_TRUE(rooms_of(evenly_lit(scene, 1), 0.5).empty());
  EXPECT_THROW(report_of(evenly_lit(scene, 1), {}), ReportError);
}

TEST(PositionIndex, FollowsTheFitOfLevin) {
  EXPECT_EQ(position_index(2, 0, 0), 1);
  EXPECT_NEAR(*position_index(1, 0.55, 0), (2.86 + 3.50) / 2, 1e-6);
  EXPECT_FALSE(position_index(1, 0, 3.01));
  EXPECT_FALSE(position_index(1, 1.85, 0)) << "behind the brow";
  EXPECT_FALSE(position_index(-1, 0, 0));
  // Levin (1975): ln p = (35.2 - 0.31889 t - 1.22 exp(-2 t / 9)) 1e-3 s + (21 + 0.26667 t - 0.002963 t2) 1e-5 s2, in degrees; t
  // is the angle from the vertical plane through the line of sight, s that from the line. He says that it differs from the curves
  // behind the table by up to 12 %.
  for (double beside = 0; beside <= 3; beside += 0.1)
    for (double above = 0; above <= 1.5; above += 0.1) {
      const double t = std::atan2(beside, above) * 180 / pi, s = std::atan(std::hypot(beside, above)) * 180 / pi;
      const double fit = std::exp((35.2 - 0.31889 * t - 1.22 * std::exp(-2 * t / 9)) * 1e-3 * s +
                                  (21 + 0.26667 * t - 0.002963 * t * t) * 1e-5 * s * s);
      const auto index = position_index(1, above, beside);
      ASSERT_TRUE(index);
      EXPECT_NEAR(*index / fit, 1, 0.16) << above << ' ' << beside;
    }
}

TEST(Illuminance, InEvenLightIsTheSameInAllDirections) {
  Scene scene = scene_of(0, 0.5);
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  const Report report = report_of(evenly_lit(scene, 200), {});  // B = 100
  ASSERT_EQ(report.rooms.size(), 1u);
  const RoomReport& room = report.rooms[0];
  EXPECT_NEAR(room.horizontal->mean.value, 100, 1e-3);
  EXPECT_NEAR(room.horizontal->uniformity(), 1, 1e-4);
  EXPECT_NEAR(room.cylindrical->mean.value, 100, 1e-3);
  for (const auto& vertical : room.light[0].vertical) EXPECT_NEAR(vertical.value(), 100, 1e-3);
}

TEST(Illuminance, IsMultipliedByTheMaintenanceFactor) {
  Scene scene = scene_of(0, 0.5);
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  ReportOptions options;
  options.maintenance_factor = 0.8;
  EXPECT_NEAR(report_of(evenly_lit(scene, 200), options).rooms[0].horizontal->minimum, 80, 1e-3);
}

/// Returns a luminaire that shines down as a Lambert emitter from a square.
Light lambert_luminaire(Vec3 position, double candela, double side) {
  auto web = std::make_shared<PhotometricWeb>();
  web->planes = {0};
  for (int angle = 0; angle <= 180; angle += 5) {
    web->angles.push_back(angle);
    web->intensities.push_back(angle < 90 ? static_cast<float>(candela * std::cos(angle * pi / 180)) : 0);
  }
  Light light;
  light.name = "lambert";
  light.kind = LightKind::luminaire;
  light.intensity = {1, 1, 1};
  light.position = position;
  light.direction = {0, -1, 0};
  light.web = web;
  light.opening = {LuminousOpening::Shape::rectangle, side, side, 0};
  light.electrical_watts = 10;
  return light;
}

TEST(Glare, OfASmallLuminaireIsThatOfTheFormula) {
  Scene scene = scene_of(0, 0.5);
  test::add_box(scene, {0, 0, 0}, {8, 3, 8}, true);
  scene.lights = {lambert_luminaire({6, 2.9, 4}, 500, 0.2)};
  const DisplayMesh mesh = evenly_lit(scene, 200);  // Lb = 100 / pi
  ReportOptions options;
  options.observers = {{{1, 1.2, 4}, {1, 0, 0}}, {{7, 1.2, 4}, {1, 0, 0}}};
  const auto& glare = report_of(mesh, options).rooms[0].glare;
  ASSERT_EQ(glare.size(), 2u);
  // 1.7 m above the eye and 5 m ahead of it. L = I / A as for every Lambert emitter.
  const double distance2 = 1.7 * 1.7 + 25, luminance = 500 / 0.04;
  const double solid_angle = 0.04 * 1.7 / std::sqrt(distance2) / distance2, index = *position_index(5, 1.7, 0);
  const double expected = 8 * std::log10(0.25 / (100 / pi) * luminance * luminance * solid_angle / (index * index));
  EXPECT_NEAR(glare[0].glare->background, 100 / pi, 1e-3);
  EXPECT_NEAR(glare[0].glare->rating.value(), expected, 0.05);
  EXPECT_FALSE(glare[1].glare->rating) << "the luminaire is behind the observer";
}

TEST(Glare, OfASurfaceThatEmitsIsThatOfALuminaireOfTheSameLuminance) {
  Scene scene = scene_of(0, 0.5);
  test::add_box(scene, {0, 0, 0}, {8, 3, 8}, true);
  Scene with_luminaire = scene;
  with_luminaire.lights = {lambert_luminaire({6, 2.9, 4}, 500, 0.2)};
  scene.materials.push_back(test::grey(pi * 500 / 0.04, 0));
  test::add_polygon(scene, {{5.9, 2.9, 3.9}, {6.1, 2.9, 3.9}, {6.1, 2.9, 4.1}, {5.9, 2.9, 4.1}}, 1);
  ReportOptions options;
  options.observers = {{{1, 1.2, 3}, {1, 0, 0}}};
  const double of_luminaire = *report_of(evenly_lit(with_luminaire, 200), options).rooms[0].glare[0].glare->rating;
  const double of_surface = *report_of(evenly_lit(scene, 200), options).rooms[0].glare[0].glare->rating;
  EXPECT_NEAR(of_luminaire, of_surface, 0.1);
}

/// Returns the form factor from a small surface to a rectangle of a x b parallel to it at distance c, above whose corner it lies
/// (Howell B-4).
double corner_factor(double a, double b, double c) {
  const double x = a / c, y = b / c, across = std::sqrt(1 + x * x), along = std::sqrt(1 + y * y);
  return (x / across * std::atan(y / across) + y / along * std::atan(x / along)) / (2 * pi);
}

/// Returns the form factor between two equal parallel squares of side a at distance c (Howell C-11).
double squares_factor(double a, double c) {
  const double x = a / c, s = 1 + x * x, t = std::sqrt(s);
  return 2 / (pi * x * x) * (std::log(s / std::sqrt(1 + 2 * x * x)) + 2 * x * t * std::atan(x / t) - 2 * x * std::atan(x));
}

TEST(Illuminance, OfFourLuminairesInAWhiteBoxIsThatOfTheZonalCavityMethod) {
  // A room of 6 x 6 x 3 m: ceiling 70 %, walls 50 %, floor 20 %; four Lambert luminaires of 1000 lm flush with its ceiling, above
  // the middles of its quarters. The work plane is the floor, so that there is no floor cavity.
  const double side = 6, height = 3, lumens = 4000, ceiling = 0.7, walls = 0.5, floor = 0.2;
  // Flux transfer between three surfaces that are each lit evenly (IES Lighting Handbook, coefficient of utilisation).
  double direct = 0;  // share of the luminaires' light that reaches the floor at once
  for (const double a : {1.5, 4.5})
    for (const double b : {1.5, 4.5}) direct += corner_factor(a, b, height);
  const double across = squares_factor(side, height), area = side * side, area_of_walls = 4 * side * height;
  const double to_walls = 1 - across, from_wall = to_walls * area / area_of_walls, between_walls = 1 - 2 * from_wall;
  double on_floor = 0, on_walls = 0, on_ceiling = 0;
  for (int n = 0; n < 200; ++n) {
    const double f = direct * lumens / area + across * ceiling * on_ceiling + to_walls * walls * on_walls;
    const double w = (1 - direct) * lumens / area_of_walls + from_wall * (ceiling * on_ceiling + floor * on_floor) +
                     between_walls * walls * on_walls;
    const double c = across * floor * on_floor + to_walls * walls * on_walls;
    on_floor = f, on_walls = w, on_ceiling = c;
  }
  const double utilisation = on_floor * area / lumens;  // CU, of a room cavity ratio of 5 * 3 * (6 + 6) / 36 = 5
  EXPECT_NEAR(utilisation, 0.62, 0.06) << "tables for a Lambert downlight, 70/50/20, RCR 5";

  Scene scene = scene_of(0, 0);
  scene.materials = {test::grey(0, floor), test::grey(0, ceiling), test::grey(0, walls)};
  test::add_box(scene, {0, 0, 0}, {side, height, side}, true, {0, 1, 2, 2, 2, 2});
  for (const double x : {1.5, 4.5})
    for (const double z : {1.5, 4.5}) scene.lights.push_back(lambert_luminaire({x, height - 1e-3, z}, 1000 / pi, 0.3));
  ReportOptions options;
  options.heights.work = 0.005;
  options.border = 0;
  options.spacing = 0.3;
  const Report report = report_of(solution_of(scene, 0.01), options);
  ASSERT_EQ(report.rooms.size(), 1u);
  EXPECT_NEAR(report.luminaires[0].lumens, 1000, 3);
  EXPECT_NEAR(report.rooms[0].horizontal->mean.value * area / lumens, utilisation, 0.02 * utilisation)
      << "the method takes walls as lit evenly";
  EXPECT_EQ(report.rooms[0].power.luminaires, 4u);
  EXPECT_EQ(report.rooms[0].power.watts, 40);
}

TEST(DaylightFactor, UnderAnOpeningInABlackRoofIsTheSkyComponent) {
  // A black room of 4 x 3 x 4 m under a roof with a hole of 2 x 2 m, and an overcast sky.
  Scene scene = scene_of(0, 0);
  scene.materials[0].two_sided = true;
  test::add_polygon(scene, {{0, 0, 0}, {0, 0, 4}, {4, 0, 4}, {4, 0, 0}});
  test::add_polygon(scene, {{0, 3, 0}, {4, 3, 0}, {4, 3, 1}, {0, 3, 1}});
  test::add_polygon(scene, {{0, 3, 3}, {4, 3, 3}, {4, 3, 4}, {0, 3, 4}});
  test::add_polygon(scene, {{0, 3, 1}, {1, 3, 1}, {1, 3, 3}, {0, 3, 3}});
  test::add_polygon(scene, {{3, 3, 1}, {4, 3, 1}, {4, 3, 3}, {3, 3, 3}});
  for (const auto& [x, z, to_x, to_z] :
       {std::array{0.0, 0.0, 4.0, 0.0}, {4.0, 0.0, 4.0, 4.0}, {4.0, 4.0, 0.0, 4.0}, {0.0, 4.0, 0.0, 0.0}})
    test::add_polygon(scene, {{x, 0, z}, {to_x, 0, to_z}, {to_x, 3, to_z}, {x, 3, z}});
  Light sky;
  sky.name = "sky";
  sky.kind = LightKind::sky;
  sky.intensity = {1000, 1000, 1000};
  sky.direction = {0, -1, 0};
  sky.sky.g = 2;
  scene.lights = {sky};
  const DisplayMesh mesh = solution_of(scene, 0.05);
  ReportOptions options;
  options.border = 0;
  options.spacing = 4;  // one point, in the middle of the part under the roof that is left
  const Report report = report_of(mesh, options, DaylightSolution{mesh, 1000});
  ASSERT_EQ(report.rooms.size(), 1u);
  ASSERT_TRUE(report.rooms[0].daylight);
  const WorkPoint& point = report.rooms[0].grid.points.at(0);
  // L / E = 3 (1 + 2 cos Z) / (7 pi) of the overcast sky, summed over the hole.
  double expected = 0;
  constexpr int steps = 400;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < steps; ++k) {
      const double x = 1 + 2 * (i + 0.5) / steps - point.along_u, z = 1 + 2 * (k + 0.5) / steps + point.along_v, y = 3 - 0.75;
      const double d2 = x * x + y * y + z * z, cosine = y / std::sqrt(d2);
      expected += 3 * (1 + 2 * cosine) / (7 * pi) * cosine * cosine / d2 * (4.0 / (steps * steps));
    }
  EXPECT_NEAR(report.rooms[0].daylight->median, expected, 0.03 * expected);
}

TEST(DaylightFactor, SharesAreOfThePoints) {
  Scene scene = scene_of(0, 0.5);
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  const DisplayMesh mesh = evenly_lit(scene, 200);
  const Report report = report_of(mesh, {}, DaylightSolution{mesh, 1000});
  EXPECT_NEAR(report.rooms[0].daylight->median, 0.1, 1e-5);
  EXPECT_NEAR(report.rooms[0].daylight->on_95_percent, 0.1, 1e-5);
}

TEST(Rooms, OfCentimetresAreRefused) {
  Scene scene = scene_of(1, 0.5);
  test::add_box(scene, {0, 0, 0}, {600, 280, 400}, true);
  EXPECT_THROW(find_rooms(evenly_lit(scene, 1), {}), ReportError);
}

TEST(Rooms, BetweenWallsOfTwoSidesThatStandOnASlabAreWhole) {
  Scene scene = scene_of(1, 0.5);
  scene.materials[0].two_sided = true;
  test::add_box(scene, {-0.15, -0.2, -5.15}, {6.15, 0, 0.15}, false);
  test::add_box(scene, {-0.15, 2.8, -5.15}, {6.15, 3, 0.15}, false);
  test::add_box(scene, {-0.15, 0, 0}, {6.15, 2.8, 0.15}, false);
  test::add_box(scene, {-0.15, 0, -5.15}, {6.15, 2.8, -5}, false);
  test::add_box(scene, {-0.15, 0, -5}, {0, 2.8, 0}, false);
  test::add_box(scene, {6, 0, -5}, {6.15, 2.8, 0}, false);
  const std::vector<Room> rooms = find_rooms(evenly_lit(scene, 1), {});
  ASSERT_EQ(rooms.size(), 1u);
  EXPECT_NEAR(rooms[0].area, 30, 0.5);
}

TEST(ReportFiles, TellOfLightsThatLightNoRoom) {
  Scene scene = scene_of(0, 0.5);
  test::add_box(scene, {0, 0, 0}, {6, 2.8, 5}, true);
  Light lamp;
  lamp.name = "bulb";
  lamp.intensity = {100, 100, 100};
  for (const Vec3 place : {Vec3{3, 2.805, 2.5}, Vec3{30, 2, 2.5}, Vec3{3, 2, 2.5}}) {
    lamp.position = place;
    scene.lights.push_back(lamp);
  }
  const Report report = report_of(evenly_lit(scene, 0), {});
  const auto remarks_with = [&](const std::string& words) {
    return std::ranges::count_if(report.remarks,
                                 [&](const std::string& remark) { return remark.find(words) != std::string::npos; });
  };
  EXPECT_EQ(remarks_with("above the ceiling of Room 1"), 1);
  EXPECT_EQ(remarks_with("hangs in no room"), 1);
  EXPECT_EQ(remarks_with("No light arrives"), 0) << "the third bulb shines";
  ASSERT_EQ(report.surfaces.size(), 1u);
  EXPECT_NEAR(report.surfaces[0].reflectance, 0.5, 1e-9);
  EXPECT_NEAR(report.surfaces[0].area, 2 * (6 * 5 + 6 * 2.8 + 5 * 2.8), 1e-6);
}

TEST(ReportFiles, CarryHostileNamesAsText) {
  Scene scene = scene_of(0, 0.5);
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  const std::string name = "<script>alert(\"x\")</script>, \"a\" & b";
  scene.objects = {{name, std::nullopt, {}, 0, 6}};
  Report report = report_of(evenly_lit(scene, 200), {});
  report.title = name;
  const std::string page = report_page(report);
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("&lt;script&gt;"), std::string::npos);
  const auto json = nlohmann::json::parse(report_json(report));
  EXPECT_EQ(json["rooms"][0]["name"], name);
  EXPECT_EQ(json["rooms"][0]["horizontal"]["points"], report.rooms[0].grid.points.size());
  EXPECT_NE(rooms_csv(report).find("\"\"x\"\""), std::string::npos);
  report.rooms[0].room.name = "=HYPERLINK(1)";  // is no formula
  EXPECT_NE(rooms_csv(report).find("\"'=HYPERLINK(1)\""), std::string::npos);
  EXPECT_EQ(std::ranges::count(points_csv(report), '\n'), 1 + static_cast<long>(report.rooms[0].grid.points.size()));
}

TEST(ReportFiles, SayThatARadiometricSceneHasNoLux) {
  Scene scene = scene_of(0, 0.5, Quantity::radiometric);
  test::add_box(scene, {0, 0, 0}, {4, 3, 4}, true);
  const Report report = report_of(evenly_lit(scene, 200), {});
  EXPECT_TRUE(report.rooms[0].glare.empty());
  const auto json = nlohmann::json::parse(report_json(report));
  EXPECT_EQ(json["unit"], "W/m2");
  EXPECT_EQ(report_page(report).find("CIE 117"), std::string::npos);
}

}  // namespace
}  // namespace alvor
