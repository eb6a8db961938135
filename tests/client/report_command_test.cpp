// Tests of `alvor report`.

#include "tests/client/room_of_eight.h"
#include "tests/command_line.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace alvor {
namespace {

class ReportCommand : public test::CommandLine {
 protected:
  ReportCommand() {
    write("room.obj", test::room_of_eight());
    write("room.mtl", test::room_materials);
  }
  nlohmann::json report(const std::string& folder) const {
    return nlohmann::json::parse(test::text_of(file(folder) / "report.json"));
  }
};

const std::string quickly = " --tolerance 0.1 --spacing 1 --verify-points 20 ";

TEST_F(ReportCommand, WritesThePageTheTablesAndThePlan) {
  const test::Ran ran = run("report room.obj -o first --quantity photometric --title 'Room <8>'" + quickly);
  ASSERT_EQ(ran.status, 0) << ran.err;
  for (const char* name : {"report.html", "report.json", "rooms.csv", "points.csv", "plan_1.png", "solution.glb"})
    EXPECT_TRUE(test::fs::exists(file("first") / name)) << name;
  const auto json = report("first");
  ASSERT_EQ(json["rooms"].size(), 1u);
  EXPECT_NEAR(json["rooms"][0]["area_m2"].get<double>(), 20, 0.1);
  EXPECT_EQ(json["rooms"][0]["glare"].size(), 4u);
  EXPECT_GT(json["verification"]["points"].get<int>(), 10);
  EXPECT_NE(test::text_of(file("first") / "report.html").find("<h1>Room &lt;8&gt;</h1>"), std::string::npos);
}

TEST_F(ReportCommand, OfASolutionIsThatOfItsScene) {
  ASSERT_EQ(run("report room.obj -o first" + quickly).status, 0);
  const test::Ran ran = run("report first/solution.glb -o again --spacing 1");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const double first = report("first")["rooms"][0]["horizontal"]["mean"]["value"],
               second = report("again")["rooms"][0]["horizontal"]["mean"]["value"];
  EXPECT_NEAR(second, first, 0.01 * first);
  EXPECT_TRUE(report("again")["verification"].is_null());
}

TEST_F(ReportCommand, TellsDaylightFactorsOfTheSceneOnly) {
  ASSERT_EQ(run("report room.obj -o first --daylight-factor" + quickly).status, 0);
  EXPECT_EQ(report("first")["rooms"][0]["daylight_factor"]["median"], 0) << "the room has no window";
  const test::Ran ran = run("report first/solution.glb -o again --daylight-factor");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("--daylight-factor: needs the scene"), std::string::npos) << ran.err;
}

TEST_F(ReportCommand, ReplacesAnEarlierReportButNotItsInput) {
  ASSERT_EQ(run("report room.obj -o first" + quickly).status, 0);
  write("first/plan_2.png", "of a room that is no more");
  write("first/report.pdf", "of an earlier report");
  EXPECT_EQ(run("report first/solution.glb -o first --spacing 1").status, 0);
  EXPECT_FALSE(test::fs::exists(file("first") / "plan_2.png"));
  EXPECT_FALSE(test::fs::exists(file("first") / "report.pdf"));
  const test::Ran ran = run("report first/solution.glb -o again --luminaire lamp.ies@1,2,3");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("--luminaire: is for scenes"), std::string::npos) << ran.err;
}

TEST_F(ReportCommand, RefusesWhatItCannotReport) {
  write("wall.obj", "mtllib room.mtl\nusemtl lamp\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  test::expect_bad_input(run("report wall.obj -o first -q"), "wall.obj: there is no floor");
  test::expect_bad_input(run("report none.obj -o first -q"), "none.obj");
  EXPECT_EQ(run("report room.obj -o first --observer 1,1,1,1,2,1" + quickly).status, 2) << "looks straight up";
  EXPECT_EQ(run("report room.obj -o first --observer 1,1,1" + quickly).status, 2);
  EXPECT_EQ(run("report room.obj -o room.obj").status, 2) << "is no folder";
  EXPECT_EQ(run("report room.obj -o first --maintenance-factor 1.5").status, 2);
  test::expect_bad_input(run("report room.obj -o first --tolerance 0.2 --spacing 0.0001 -q"),
                         "room.obj: Room 1: more than 100000");
}

}  // namespace
}  // namespace alvor
