// Tests of probing: irradiance and radiosity at points.

#include "client/verify/probe.h"
#include "import/base/whole_file.h"
#include "tests/client/hand_made_mesh.h"
#include "tests/cutouts.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>

namespace alvor {
namespace {

DisplayMesh sloping_floor() {
  DisplayMesh mesh;
  add_wall(mesh, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 4, [](const Vec3& p) { return grey(static_cast<float>(1 + p.x + 2 * p.z)); });
  return mesh;
}

TEST(Probe, InterpolatesWithinTriangles) {
  const std::vector<ProbePoint> points{{{0.31, 0, 0.77}, {0, 1, 0}}, {{0.9, 0.00009, 0.05}, {0, 3, 0}}};
  const auto samples = probe(sloping_floor(), points);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_NEAR(samples[0].radiosity.g, 1 + 0.31 + 2 * 0.77, 1e-5);
  EXPECT_NEAR(samples[0].irradiance.r, 2 * (1 + 0.31 + 2 * 0.77), 1e-5);
  EXPECT_NEAR(samples[1].radiosity.b, 1 + 0.9 + 2 * 0.05, 1e-5);
}

TEST(Probe, TellsTheErrorOfTheSolutionOnSurfacesOnly) {
  DisplayMesh mesh = sloping_floor();
  const std::vector<ProbePoint> points{{{0.31, 0, 0.77}, {0, 1, 0}}, {{0.31, 0.5, 0.77}, {0, 1, 0}}};
  EXPECT_TRUE(std::isnan(probe(mesh, points)[0].error));
  mesh.errors.assign(mesh.positions.size(), 0.125f);
  const auto samples = probe(mesh, points);
  EXPECT_NEAR(samples[0].error, 0.125, 1e-6);
  EXPECT_TRUE(std::isnan(samples[1].error));
}

TEST(Probe, TakesTheSideOfAThinWallThatFacesTheSameWay) {
  DisplayMesh wall;
  add_wall(wall, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, [](const Vec3&) { return grey(1); });      // faces +z
  add_wall(wall, {0, 0, -0.01}, {0, 1, 0}, {1, 0, 0}, 1, [](const Vec3&) { return grey(2); });  // faces -z
  const auto samples =
      probe_surfaces(wall, std::vector<ProbePoint>{{{0.4, 0.4, -0.009}, {0, 0, 1}}, {{0.4, 0.4, 0.2}, {0, 0, -1}}});
  EXPECT_FLOAT_EQ(samples[0].radiosity.r, 1);
  EXPECT_FLOAT_EQ(samples[1].radiosity.r, 2);
}

/// Returns a cube from 0 to `side` whose walls face inwards. The ceiling emits 1 and reflects nothing; all others have radiosity
/// 0.25.
DisplayMesh lit_room(double side) {
  DisplayMesh mesh;
  const Vec3 x{side, 0, 0}, y{0, side, 0}, z{0, 0, side};
  const auto dim = [](const Vec3&) { return grey(0.25F); };
  add_wall(mesh, {0, 0, 0}, z, x, 3, dim);
  add_wall(mesh, {0, 0, 0}, x, y, 3, dim);
  add_wall(mesh, {0, 0, 0}, y, z, 3, dim);
  add_wall(mesh, z, y, x, 3, dim);
  add_wall(mesh, x, z, y, 3, dim);
  add_wall(mesh, y, x, z, 3, [](const Vec3&) { return grey(1); });
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) mesh.irradiance[v] = grey(mesh.radiosity[v].r < 1 ? 0.5F : 0);
  return mesh;
}

TEST(Probe, GathersInTheAir) {
  // The form factor from the centre of a cube to a wall is that to a square at half its side's distance: 0.5541 (Howell, B-3).
  const double ceiling = 0.554144;
  const auto samples = probe(lit_room(2), std::vector<ProbePoint>{{{1, 1, 1}, {0, 1, 0}}, {{1, 1, 1}, {0, -1, 0}}});
  ASSERT_EQ(samples[0].place, ProbePlace::in_air);
  EXPECT_NEAR(samples[0].irradiance.g, ceiling + 0.25 * (1 - ceiling), 3 * samples[0].standard_error + 1e-6);
  EXPECT_NEAR(samples[1].irradiance.g, 0.25, 3 * samples[1].standard_error + 1e-6);
  EXPECT_LT(samples[0].standard_error, 0.01);
  EXPECT_NEAR(samples[0].distance, 1, 1e-6);
  EXPECT_TRUE(std::isnan(samples[0].radiosity.g));
}

TEST(Probe, GathersTheLightOfLamps) {
  DisplayMesh room = lit_room(2);
  for (RgbF& each : room.radiosity) each = {};
  for (RgbF& each : room.irradiance) each = {};
  Light lamp{"bulb", LightKind::point, {10, 20, 30}, {1, 1.5, 1}}, ball{"ball", LightKind::point, {10, 20, 30}, {1, 1.75, 1}};
  ball.radius = 0.1;
  room.lights = {lamp, ball};
  const std::vector<ProbePoint> points{{{1, 0.5, 1}, {0, 1, 0}}, {{1, 0.5, 1}, {0, -1, 0}}};
  const auto samples = probe(room, points);
  const double expected = 20 / 1.0 + 20 / (1.25 * 1.25);
  EXPECT_NEAR(samples[0].irradiance.g, expected, 1e-4 * expected);
  EXPECT_NEAR(samples[0].irradiance.r, expected / 2, 1e-4 * expected);
  EXPECT_EQ(samples[1].irradiance.g, 0);
}

TEST(Probe, GathersPastWhatStandsInTheLight) {
  DisplayMesh room = lit_room(2);
  // Adds a two-sided sheet halfway up, over the half of the room with x < 1. Seen from below it hides half of the ceiling's
  // light.
  add_wall(room, {0, 1.5, 0}, {1, 0, 0}, {0, 0, 2}, 1, [](const Vec3&) { return grey(0); });
  add_wall(room, {0, 1.5, 0}, {0, 0, 2}, {1, 0, 0}, 1, [](const Vec3&) { return grey(0); });
  const auto sample = probe(room, std::vector<ProbePoint>{{{1, 1, 1}, {0, 1, 0}}})[0];
  // The sheet's form factor is twice that of a rectangle of 1 x 1 at distance 0.5 seen from below its corner (Howell, B-4). Below
  // its rim the walls are visible.
  const double ceiling = 0.554144, covered = 0.415538;
  const double expected = 0.5 * (ceiling + 0.25 * (1 - ceiling)) + 0.25 * (0.5 - covered);
  EXPECT_GT(sample.standard_error, 0);
  EXPECT_NEAR(sample.irradiance.g, expected, 4 * sample.standard_error);
}

TEST(Probe, GathersThroughPanes) {
  const std::vector<ProbePoint> point{{{1, 1, 1}, {0, 1, 0}}};
  const auto with_sheet = [&](const Rgb& transmittance, bool two_sided) {
    DisplayMesh room = lit_room(2);
    const auto walls = static_cast<std::uint32_t>(room.triangles.size());
    room.materials = {{"wall", {}, {0.5, 0.5, 0.5}, false}, {"pane", {}, {}, two_sided, transmittance}};
    if (two_sided) add_wall(room, {0, 1.50001, 0}, {0, 0, 2}, {1, 0, 0}, 1, [](const Vec3&) { return grey(0); });
    add_wall(room, {0, 1.5, 0}, {1, 0, 0}, {0, 0, 2}, 1, [](const Vec3&) { return grey(0); });
    room.faces = {{{}, 0, walls}, {{}, 1, static_cast<std::uint32_t>(room.triangles.size()) - walls}};
    return probe(room, point)[0];
  };
  const auto clear = probe(lit_room(2), point)[0];
  for (const bool two_sided : {false, true}) {
    const auto blocked = with_sheet({}, two_sided), tinted = with_sheet({0.5, 0.2, 1}, two_sided);
    const double hidden = clear.irradiance.g - blocked.irradiance.g, noise = 4 * (clear.standard_error + tinted.standard_error);
    EXPECT_GT(hidden, 20 * noise / 4);
    EXPECT_NEAR(tinted.irradiance.r, blocked.irradiance.g + 0.5 * hidden, noise);
    EXPECT_NEAR(tinted.irradiance.g, blocked.irradiance.g + 0.2 * hidden, noise);
    EXPECT_NEAR(tinted.irradiance.b, clear.irradiance.g, noise);
  }
}

/// Returns a material of one texel that reflects half of the light, of which this share of 255 is there.
Material cut_out(std::uint8_t opacity) { return test::textured(test::cut_out(1, 1, 255, {opacity}), {0.5, 0.5, 0.5}); }

TEST(Probe, AShareOfASheetThatIsCutOutCountsAsAPane) {
  const std::vector<ProbePoint> point{{{1, 1, 1}, {0, 1, 0}}};
  const auto with_sheet = [&](const Material& material, float radiosity) {
    DisplayMesh room = lit_room(2);
    const auto walls = static_cast<std::uint32_t>(room.triangles.size());
    room.materials = {{"wall", {}, {0.5, 0.5, 0.5}, false}, material};
    add_wall(room, {0, 1.50001, 0}, {0, 0, 2}, {1, 0, 0}, 1, [&](const Vec3&) { return grey(radiosity); });
    add_wall(room, {0, 1.5, 0}, {1, 0, 0}, {0, 0, 2}, 1, [&](const Vec3&) { return grey(radiosity); });
    room.faces = {{{}, 0, walls}, {{}, 1, static_cast<std::uint32_t>(room.triangles.size()) - walls}};
    if (material.texture) room.texture_points.assign(room.positions.size(), {0.5F, 0.5F});
    return probe(room, point)[0].irradiance;
  };
  // The first sheet is there to 0.4, and what is there lets half of the light through.
  Material sheet = cut_out(102), pane{"pane", {}, {0.2, 0.2, 0.2}, true, {0.8, 0.8, 0.8}};
  sheet.two_sided = true;
  sheet.regular_transmittance = {0.5, 0.5, 0.5};
  EXPECT_NEAR(with_sheet(sheet, 0.5F).g, with_sheet(pane, 0.4F * 0.5F).g, 1e-5);
  Material hole = cut_out(0);
  hole.two_sided = true;
  EXPECT_NEAR(with_sheet(hole, 0.5F).g, probe(lit_room(2), point)[0].irradiance.g, 1e-5);
}

TEST(Probe, AnEmitterShinesWhereItIsThere) {
  DisplayMesh room = lit_room(2);
  room.materials = {{"wall", {}, {0.5, 0.5, 0.5}, false}, cut_out(102)};
  room.materials[1].emission = {1, 1, 1};
  const auto walls = static_cast<std::uint32_t>(room.triangles.size()) * 5 / 6;
  room.faces = {{{}, 0, walls}, {{}, 1, walls / 5}};
  room.texture_points.assign(room.positions.size(), {0.5F, 0.5F});
  const double ceiling = 0.554144;  // see GathersInTheAir
  const auto sample = probe(room, std::vector<ProbePoint>{{{1, 1, 1}, {0, 1, 0}}})[0];
  EXPECT_NEAR(sample.irradiance.g, 0.4 * ceiling + 0.25 * (1 - ceiling), 3 * sample.standard_error + 1e-6);
}

// More leaves a translucent sheet than its front receives, and yet it is no emitter.
TEST(Probe, GathersLightThatComesThroughASheet) {
  const std::vector<ProbePoint> point{{{1, 1, 1}, {0, 1, 0}}};
  DisplayMesh room = lit_room(2);
  room.transmitted.resize(room.positions.size());
  for (std::size_t v = 0; v < room.positions.size(); ++v)
    if (room.irradiance[v].r == 0) room.transmitted[v] = room.radiosity[v];
  const double ceiling = 0.554144;
  const auto sample = probe(room, point)[0];
  EXPECT_NEAR(sample.irradiance.g, ceiling + 0.25 * (1 - ceiling), 4 * sample.standard_error);
  EXPECT_LT(sample.standard_error, 0.02);
}

TEST(Probe, PointsInHolesHaveIrradianceAndNoRadiosity) {
  DisplayMesh mesh = sloping_floor();
  mesh.materials = {test::textured(test::cut_out(2, 1, 255, {0, 255}), {0.5, 0.5, 0.5}, Wrap::clamp)};
  mesh.faces = {{{}, 0, static_cast<std::uint32_t>(mesh.triangles.size())}};
  for (const Vec3& p : mesh.positions) mesh.texture_points.push_back({static_cast<float>(p.x), static_cast<float>(p.z)});
  const auto samples = probe(mesh, std::vector<ProbePoint>{{{0.31, 0, 0.77}, {0, 1, 0}}, {{0.71, 0, 0.77}, {0, 1, 0}}});
  EXPECT_NEAR(samples[0].irradiance.r, 2 * (1 + 0.31 + 2 * 0.77), 1e-5);
  EXPECT_EQ(samples[0].radiosity, grey(0));
  EXPECT_NEAR(samples[1].radiosity.g, 1 + 0.71 + 2 * 0.77, 1e-5);
}

TEST(Probe, AMediumDimsWhatIsGathered) {
  // All surfaces visible from the middle of the room are at least 1 m away, and at most the room's diagonal.
  const auto clear = probe(lit_room(2), std::vector<ProbePoint>{{{1, 1, 1}, {0, 1, 0}}})[0];
  const auto dim = probe(lit_room(2), std::vector<ProbePoint>{{{1, 1, 1}, {0, 1, 0}}}, {0, 1, 2})[0];
  EXPECT_NEAR(dim.irradiance.r, clear.irradiance.r, 1e-6);
  EXPECT_LT(dim.irradiance.g, std::exp(-1.0) * clear.irradiance.g);
  EXPECT_GT(dim.irradiance.g, std::exp(-std::sqrt(3.0)) * clear.irradiance.g);
  EXPECT_LT(dim.irradiance.b, std::exp(-2.0) * clear.irradiance.b);
}

TEST(Probe, TheStandardErrorIsThatOfTheSpread) {
  // The ceiling's light comes through slats, drawn as many small triangles.
  DisplayMesh room = lit_room(2);
  for (int n = 0; n < 8; ++n) {
    add_wall(room, {0.25 * n, 1.5, 0}, {0.12, 0, 0}, {0, 0, 2}, 1, [](const Vec3&) { return grey(0); });
    add_wall(room, {0.25 * n, 1.5, 0}, {0, 0, 2}, {0.12, 0, 0}, 1, [](const Vec3&) { return grey(0); });
  }
  std::vector<ProbePoint> points;
  for (int n = 0; n < 100; ++n) points.push_back({{1 + 1e-6 * n, 1, 1}, {0, 1, 0}});
  double sum = 0, squares = 0, told = 0;
  for (const ProbeSample& sample : probe(room, points)) {
    const double value = (double{sample.irradiance.r} + double{sample.irradiance.g} + double{sample.irradiance.b}) / 3;
    sum += value, squares += value * value, told += sample.standard_error / 100;
  }
  const double spread = std::sqrt((squares - sum * sum / 100) / 99);
  EXPECT_GT(told, 0.5 * spread);
  EXPECT_LT(told, 4 * spread);
}

TEST(Probe, SaysNanOutsideTheRoom) {
  const auto samples = probe(lit_room(2), std::vector<ProbePoint>{{{1, 3, 1}, {0, -1, 0}}, {{1, 1.9, 1}, {0, -1, 0}}});
  EXPECT_EQ(samples[0].place, ProbePlace::enclosed);
  EXPECT_EQ(samples[1].place, ProbePlace::in_air);
  EXPECT_EQ(samples_csv(std::span(samples).first(1)),
            "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,radiosity_r,radiosity_g,radiosity_b,distance,standard_error,"
            "irradiance_error\n"
            "1,3,1,0,-1,0,nan,nan,nan,nan,nan,nan,1,nan,nan\n");
}

/// A points file, removed at the end of the test.
struct PointsFile {
  std::filesystem::path path = std::filesystem::temp_directory_path() / ("alvor_points_" + std::to_string(getpid()) + ".csv");
  explicit PointsFile(std::string_view text) { write_whole_file(path, text); }
  ~PointsFile() { std::filesystem::remove(path); }
};

std::string refusal(std::string_view text) {
  const PointsFile file(text);
  try {
    read_points(file.path);
    return "none";
  } catch (const FileError& error) {
    return std::string(error.what()).substr(file.path.string().size());
  }
}

TEST(PointsFile, MayHaveAHeaderBlankLinesAndCarriageReturns) {
  const PointsFile file("x,y,z,nx,ny,nz\r\n\r\n1,2,3,0,0,-1\r\n\n 4 , 5e1,-6.25,0,1,0");
  const auto points = read_points(file.path);
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].point, (Vec3{1, 2, 3}));
  EXPECT_EQ(points[1].point, (Vec3{4, 50, -6.25}));
  EXPECT_EQ(points[1].normal, (Vec3{0, 1, 0}));
}

TEST(PointsFile, ErrorsNameTheLine) {
  EXPECT_EQ(refusal("1,2,3,0,0,1\n\n1,2,3,0,0\n"), ": line 3: needs x,y,z,nx,ny,nz but has 5 fields");
  EXPECT_EQ(refusal("1,2,3,0,0,1\nx,2,3,0,0,1\n"), ": line 2: 'x' is not a finite number");
  EXPECT_EQ(refusal("1,2,nan,0,0,1\n"), ": line 1: 'nan' is not a finite number");
  EXPECT_EQ(refusal("1,2,3,0,0,0\n"), ": line 1: the normal has no direction");
}

}  // namespace
}  // namespace alvor
