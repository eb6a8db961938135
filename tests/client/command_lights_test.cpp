// Tests how the built command `alvor` reads lamps, luminaires, environment maps and glass.

#include "tests/client/room_of_eight.h"
#include "tests/command_line.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <numbers>
#include <sstream>
#include <string>

namespace alvor {
namespace {

using CommandLights = test::CommandLine;
using test::expect_bad_input;
using test::Ran;
using test::room_materials;
using test::room_of_eight;
using test::text_of;

TEST_F(CommandLights, ALampGivenTwiceShinesOnceAndIsSaid) {
  write("room.mtl", room_materials);
  write("once.obj", room_of_eight());
  write("twice.obj", room_of_eight("usemtl lamp\nf 10 11 12 9\n"));
  ASSERT_EQ(run("solve once.obj --tolerance 0.1 -o once.ply").status, 0);
  const Ran ran = run("solve twice.obj --tolerance 0.1 -o twice.ply");
  EXPECT_NE(ran.err.find("1 faces lie in the place of others and were left out: the first is face 8, in the place of face 6."),
            std::string::npos)
      << ran.err;
  EXPECT_EQ(text_of(file("twice.ply")), text_of(file("once.ply")));
}

TEST_F(CommandLights, ALuminaireIsDescribedAndDrawn) {
  const Ran ran = run("luminaire '" ALVOR_SCENES "/luminaires/pendant.ldt' --json -o polar.png");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_NEAR(json.at("lumens").get<double>(), json.at("stated_lumens").get<double>(), 0.01 * json.at("lumens").get<double>());
  EXPECT_EQ(json.at("opening").at("shape"), "rectangle");
  EXPECT_EQ(text_of(file("polar.png")).substr(1, 3), "PNG");
  write("bad.ies", "IESNA91\nTILT=NONE\n1 1 1 nine\n");
  const Ran bad = run("luminaire bad.ies");
  EXPECT_EQ(bad.status, 3);
  EXPECT_EQ(bad.err, "alvor: bad.ies: line 3: 'nine' is not a number, needs its number of vertical angles\n");
}

TEST_F(CommandLights, LuminairesLightARoomInLux) {
  write("room.mtl", room_materials);
  write("room.obj", room_of_eight());
  const std::string panel = "--luminaire '" ALVOR_SCENES "/luminaires/panel.ies@1,0.8,1:0,30,45' ";
  const auto mean = [&](const std::string& options) {
    const Ran ran = run("solve --json " + panel + "room.obj " + options);
    EXPECT_EQ(ran.status, 0) << ran.err;
    return nlohmann::json::parse(ran.out);
  };
  const auto photometric = mean("--quantity photometric --tolerance 0.2"), radiometric = mean("--tolerance 0.2");
  EXPECT_EQ(photometric.at("irradiance_unit"), "lx");
  EXPECT_EQ(radiometric.at("irradiance_unit"), "W/m2");
  EXPECT_GT(photometric.at("mean_irradiance"), radiometric.at("mean_irradiance"));
  EXPECT_NE(radiometric.at("warnings").dump().find("1/179 W"), std::string::npos);
  EXPECT_EQ(run("solve room.obj --luminaire panel.ies").status, 2);
  EXPECT_EQ(run("solve room.obj --luminaire absent.ies@1,1,1").status, 3);
}

TEST_F(CommandLights, AnEnvironmentMapLightsAScene) {
  write("floor.obj", "v 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nf 1 2 3 4\n");
  std::string grey = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n";
  for (int pixel = 0; pixel < 16 * 8; ++pixel) grey += "\x80\x80\x80\x81";  // radiance 1
  write("grey.hdr", grey);
  const Ran ran = run("solve floor.obj --json --environment grey.hdr --environment-scale 2 --environment-turn 90");
  ASSERT_EQ(ran.status, 0) << ran.err;
  EXPECT_NEAR(nlohmann::json::parse(ran.out).at("mean_irradiance").get<double>(), 2 * std::numbers::pi, 0.01);
  EXPECT_EQ(run("solve floor.obj --environment grey.png").status, 2);
  EXPECT_EQ(run("solve floor.obj --environment-scale 2").status, 2);
  EXPECT_EQ(run("solve floor.obj --environment absent.hdr").status, 3);
  write("cut.hdr", grey.substr(0, 100));
  expect_bad_input(run("solve floor.obj --environment cut.hdr"), "cut.hdr");
}

TEST_F(CommandLights, GlassLetsLightThrough) {
  write("room.mtl", "newmtl lamp\nKe 10 10 10\nnewmtl glass\nKd 0 0 0\nd 0.25\nnewmtl floor\nKd 0 0 0\n");
  const std::string scene =
      "mtllib room.mtl\nv 0 0 0\nv 0 0 1\nv 1 0 1\nv 1 0 0\nv 0 2 0\nv 1 2 0\nv 1 2 1\nv 0 2 1\n"
      "v -9 1 -9\nv 9 1 -9\nv 9 1 9\nv -9 1 9\nusemtl floor\nf 1 2 3 4\nusemtl lamp\nf 5 6 7 8\n";
  write("open.obj", scene);
  write("glazed.obj", scene + "usemtl glass\nf 9 10 11 12\n");
  write("middle.csv", "0.5,0,0.5,0,1,0\n");
  const auto irradiance = [&](const std::string& name) {
    EXPECT_EQ(run("solve " + name + ".obj -o " + name + ".glb --tolerance 0.05").status, 0);
    const std::string line = run("probe " + name + ".glb --points middle.csv").out;
    std::istringstream cells(line.substr(line.find('\n') + 1));
    std::string cell;
    for (int n = 0; n < 7; ++n) std::getline(cells, cell, ',');
    return std::stod(cell);
  };
  const double open = irradiance("open"), glazed = irradiance("glazed");
  EXPECT_GT(open, 1);
  EXPECT_NEAR(glazed, 0.75 * open, 0.01 * open);
  EXPECT_NE(run("explain glazed.obj").out.find("light goes straight through 1 of 3 faces"), std::string::npos);
}

}  // namespace
}  // namespace alvor
