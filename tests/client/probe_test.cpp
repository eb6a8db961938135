// Points in, irradiance and radiosity out.

#include "client/probe.h"
#include "client/whole_file.h"
#include "tests/client/hand_made_mesh.h"

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
  const std::vector<ProbePoint> points{{{0.31, 0, 0.77}, {0, 1, 0}}, {{0.9, 0.001, 0.05}, {0, 3, 0}}};
  const auto samples = probe(sloping_floor(), points);
  ASSERT_EQ(samples.size(), 2u);
  EXPECT_NEAR(samples[0].radiosity.g, 1 + 0.31 + 2 * 0.77, 1e-5);
  EXPECT_NEAR(samples[0].irradiance.r, 2 * (1 + 0.31 + 2 * 0.77), 1e-5);
  EXPECT_NEAR(samples[1].radiosity.b, 1 + 0.9 + 2 * 0.05, 1e-5);
}

TEST(Probe, TakesTheSideOfAThinWallThatFacesTheSameWay) {
  DisplayMesh wall;
  add_wall(wall, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, [](const Vec3&) { return grey(1); });      // faces +z
  add_wall(wall, {0, 0, -0.01}, {0, 1, 0}, {1, 0, 0}, 1, [](const Vec3&) { return grey(2); });  // faces -z
  const auto samples = probe(wall, std::vector<ProbePoint>{{{0.4, 0.4, -0.009}, {0, 0, 1}}, {{0.4, 0.4, 0.2}, {0, 0, -1}}});
  EXPECT_FLOAT_EQ(samples[0].radiosity.r, 1);
  EXPECT_FLOAT_EQ(samples[1].radiosity.r, 2);
}

TEST(Probe, SaysNanWhereNothingFacesTheSameWay) {
  const auto samples = probe(sloping_floor(), std::vector<ProbePoint>{{{0.5, 0, 0.5}, {0, -1, 0}}});
  EXPECT_FALSE(samples[0].found);
  EXPECT_EQ(samples_csv(samples),
            "x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,radiosity_r,radiosity_g,radiosity_b\n"
            "0.5,0,0.5,0,-1,0,nan,nan,nan,nan,nan,nan\n");
}

/// A points file, removed at the end.
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
