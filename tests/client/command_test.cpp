// Tests the built command `alvor` as users see it: exit statuses, streams and files.

#include "client/command/output/snapshots.h"
#include "tests/client/room_of_eight.h"
#include "tests/command_line.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>

namespace alvor {
namespace {

const std::string cornell_box = ALVOR_SCENES "/cornell_box.obj";
const std::string points = ALVOR_TEST_FILES "/truth/cornell_box.points.csv";
const std::string quick = " --tolerance 0.3 --max-depth 2 --seed 7";

std::string cell(std::uint64_t number) { return std::string(",").append(std::to_string(number)).append(","); }

using Command = test::CommandLine;
using test::expect_bad_input;
using test::line_count;
using test::Ran;
using test::room_materials;
using test::room_of_eight;
using test::text_of;
namespace fs = std::filesystem;

TEST_F(Command, WithoutArgumentsIsAUsageError) { EXPECT_EQ(run("").status, 2); }

TEST_F(Command, HelpIsNoError) { EXPECT_EQ(run("solve --help").status, 0); }

TEST_F(Command, UnknownFlagsAreUsageErrors) { EXPECT_EQ(run("solve " + cornell_box + " --no-such-flag").status, 2); }

TEST_F(Command, ImpossibleOptionValuesAreUsageErrors) {
  for (const std::string option : {"--tolerance 2", "--tolerance nan", "--max-depth 16", "--time-limit -1", "--strategy magic",
                                   "--seed -1", "--translucent white", "--translucent =0.5", "--translucent white=2",
                                   "--translucent white=0.1,0.2", "--translucent white=nan"})
    EXPECT_EQ(run("solve " + cornell_box + " " + option).status, 2) << option;
}

TEST_F(Command, FaultsOfAScriptOfEditsAreToldInPlainWords) {
  const auto fault_of = [&](const std::string& script) {
    write("edits.json", script);
    const Ran ran = run("edit scenes/a/solves/b --server localhost:1 --script edits.json");
    EXPECT_EQ(ran.status, 2);
    return ran.err;
  };
  const std::pair<std::string, std::string> faults[]{
      {R"({"edits": [{"light": {"name": "a", "dim": "half"}}]})", "edits[0].light.dim: \"half\" is no number"},
      {R"({"edits": [{"object": {"name": "a", "hidden": 7}}]})", "edits[0].object.hidden: 7 is neither true nor false"},
      {R"({"edits": [{"light": {"name": "a"}, "object": {"name": "b"}}]})", "edits[0]: 'object' is a second part"},
      {R"({"edits": [{"light": {"nam": "a"}}]})", "edits[0].light: there is no field 'nam'"},
      {R"({"edits": [{"object": {"name": "a", "move": [1, 2, 3]}}]})", "edits[0].object: 'move' is no list"},
      {R"({"kind": "REPEAT"})", "kind: \"REPEAT\" is none of its values"}};
  for (const auto& [script, told] : faults) EXPECT_NE(fault_of(script).find("edits.json: " + told), std::string::npos) << script;
  EXPECT_LT(fault_of(R"({"edits": [{"light": {"dim": ")" + std::string(100'000, 'x') + R"("}}]})").size(), 400u);
}

TEST_F(Command, OutputsThatCannotBeWrittenAreFoundBeforeTheSolve) {
  for (const std::string option : {"-o room.obj", "-o nowhere/room.glb", "--report nowhere/r.csv"}) {
    const Ran ran = run("solve missing.obj " + option);
    EXPECT_EQ(ran.status, 2) << option;
    EXPECT_EQ(line_count(ran.err), 1) << ran.err;
  }
}

TEST_F(Command, MissingSceneIsNamedInOneLine) { expect_bad_input(run("solve missing.obj"), "missing.obj"); }

TEST_F(Command, AMaterialThatIsToBeTranslucentMustBeInTheScene) {
  expect_bad_input(run("solve " + cornell_box + " --translucent curtain=0.3"),
                   "'curtain': is not in the scene, which has 'white'");
  EXPECT_EQ(run("explain " + cornell_box + " --translucent white=0.1,0.2,0.3 --translucent green=0.1").status, 0);
}

TEST_F(Command, SolutionThatIsNoneIsNamedInOneLine) {
  write("room.ply", "not a solution\n");
  expect_bad_input(run("probe room.ply --points " + points), "room.ply");
}

TEST_F(Command, UnreachableServerHasItsOwnStatus) {
  const Ran ran = run("solve " + cornell_box + " --server 127.0.0.1:1");
  EXPECT_EQ(ran.status, 4);
  EXPECT_EQ(line_count(ran.err), 1) << ran.err;
}

TEST_F(Command, SceneWithoutEmittersIsSolvedWithAWarning) {
  write("dark.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const Ran ran = run("solve dark.obj -o dark.ply");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.err.find("warning: "), std::string::npos) << ran.err;
  EXPECT_TRUE(fs::exists(file("dark.ply")));
}

TEST_F(Command, ACameraInAWallIsToldAndOfferedAPlaceInside) {
  write("room.mtl", room_materials);
  write("room.obj", room_of_eight());
  ASSERT_EQ(run("solve room.obj --tolerance 0.2 -o room.glb").status, 0);
  const Ran in_wall = run("render room.glb -o in_wall.png --eye -0.1,1,2 --target -5,1,2");
  EXPECT_EQ(in_wall.status, 0) << in_wall.err;
  const std::size_t offer = in_wall.err.find("Try --eye ");
  ASSERT_NE(offer, std::string::npos) << in_wall.err;
  EXPECT_NE(in_wall.err.find("the camera at -0.1,1,2 sees nothing but black"), std::string::npos) << in_wall.err;
  const std::string view = in_wall.err.substr(offer + 4, in_wall.err.find('\n', offer) - offer - 4);
  const Ran inside = run("render room.glb -o inside.png " + view);
  EXPECT_EQ(inside.status, 0) << inside.err;
  EXPECT_EQ(inside.err, "");
}

TEST_F(Command, GreyIsNotCalledColouredForItsRounding) {
  write("room.mtl", "newmtl white\nKd 0.2 0.2 0.2\nnewmtl lamp\nKd 0 0 0\nKe 0.1 0.1 0.1\n");
  write("room.obj", room_of_eight());
  const Ran ran = run("explain room.obj");
  EXPECT_NE(ran.out.find("three bands      off"), std::string::npos) << ran.out;
}

TEST_F(Command, FacesOfStlKeepTheirNumbersInFormFactors) {
  const std::string cube_stl = ALVOR_TEST_FILES "/client/good_files/cube.stl";
  const Ran ran = run("form-factors " + cube_stl + " -o F.csv --areas A.csv");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("12 faces"), std::string::npos) << ran.out;
  EXPECT_EQ(line_count(text_of(file("A.csv"))), 13);
  EXPECT_NE(text_of(file("A.csv")).find("\n11,0.5\n"), std::string::npos);
  // The cube's faces look outwards. A user who meant a furnace gets a dark scene.
  EXPECT_NE(ran.err.find("every face looks away from every other: are the normals turned round?"), std::string::npos) << ran.err;
  EXPECT_EQ(ran.err.find("light"), std::string::npos) << ran.err;
}

TEST_F(Command, FormFactorsThatAreLessSureThanAskedAreCounted) {
  write("room.mtl", room_materials);
  write("room.obj", room_of_eight("v 1.3 1 2\nv 2 1 2.2\nv 2 1.5 2\nf 17 18 19\n"));
  const Ran strict = run("form-factors room.obj -o F.csv --accuracy 1e-12"),
            lax = run("form-factors room.obj -o F.csv --accuracy 0.1");
  EXPECT_NE(strict.err.find(" form factors have an error bound above the accuracy of 1e-12: the worst is "), std::string::npos)
      << strict.err;
  EXPECT_EQ(lax.err.find("warning"), std::string::npos) << lax.err;
}

TEST_F(Command, OnePairAndTheMatrixAgreeWithinTheirBounds) {
  ASSERT_EQ(run("form-factors " ALVOR_SCENES "/enfilade.obj -o F.csv").status, 0);
  std::istringstream lines(text_of(file("F.csv")));
  std::string line;
  std::getline(lines, line);
  int compared = 0;
  for (int n = 0; std::getline(lines, line); ++n) {
    if (n % 400 != 0) continue;
    unsigned from = 0, to = 0;
    double value = 0, bound = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%u,%u,%lf,%lf", &from, &to, &value, &bound), 4) << line;
    const Ran one =
        run("form-factor " ALVOR_SCENES "/enfilade.obj " + std::to_string(from) + " " + std::to_string(to) + " --json");
    for (const auto& method : nlohmann::json::parse(one.out)) {
      if (method.at("method") != "analytic") continue;
      EXPECT_NEAR(method.at("value").get<double>(), value, method.at("error_bound").get<double>() + bound + 1e-14) << line;
      ++compared;
    }
  }
  EXPECT_GT(compared, 20);
}

TEST_F(Command, ASolveThatWasCutShortSaysWhatHasNoLightYet) {
  write("office.obj", "");
  const std::string office = "'" ALVOR_BINARIES "/office_block' --faces 20000 -o office.obj";
  ASSERT_EQ(std::system(("cd '" + file("").string() + "' && " + office + " > /dev/null").c_str()), 0);
  const Ran cut = run("solve office.obj --json --time-limit 0.001");
  const double unlit = nlohmann::json::parse(cut.out).at("unlit_fraction");
  EXPECT_GT(unlit, 0) << cut.out;
  EXPECT_EQ(nlohmann::json::parse(run("solve " + cornell_box + quick + " --json").out).at("unlit_fraction"), 0);
}

TEST_F(Command, JsonIsAllThatStdoutHolds) {
  const Ran ran = run("solve " + cornell_box + quick + " --json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out);
  for (const char* field : {"solve", "state", "end_reason", "elapsed_s", "cpu_s", "traversal_share", "shots", "rays", "leaves",
                            "unshot_fraction", "estimated_error", "first_frame_s", "warnings"})
    EXPECT_TRUE(json.contains(field)) << field;
  EXPECT_EQ(json["state"], "SUCCEEDED");
  EXPECT_GT(json["rays"], 0);
}

TEST_F(Command, ReportHasALinePerStepAndEndsWithTheOutcome) {
  const Ran ran = run("solve " + cornell_box + quick + " --json --report r.csv");
  ASSERT_EQ(ran.status, 0) << ran.err;
  std::istringstream report(text_of(file("r.csv")));
  std::string line, last;
  std::getline(report, line);
  EXPECT_EQ(line, "elapsed_s,step,shots,rays,leaves,unshot_fraction,estimated_error");
  for (std::uint64_t step = 0; std::getline(report, line); ++step, last = line) {
    EXPECT_EQ(std::ranges::count(line, ','), 6) << line;
    EXPECT_NE(line.find(cell(step)), std::string::npos) << line;
  }
  const auto rays = nlohmann::json::parse(ran.out)["rays"].get<std::uint64_t>();
  EXPECT_NE(last.find(cell(rays)), std::string::npos) << last;
}

TEST_F(Command, ProbeAnswersEveryPointInOrder) {
  for (const std::string solution : {"room.glb", "room.ply"}) {
    ASSERT_EQ(run("solve " + cornell_box + quick + " -o " + solution).status, 0);
    const Ran ran = run("probe " + solution + " --points " + points);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(line_count(ran.out), 1 + line_count(text_of(points)));
    EXPECT_TRUE(ran.out.starts_with("x,y,z,nx,ny,nz,irradiance_r,irradiance_g,irradiance_b,radiosity_r,")) << ran.out;
  }
}

TEST_F(Command, FramesAndPicturesAreDrawn) {
  ASSERT_EQ(run("solve " + cornell_box + quick + " -o room.glb --frames film").status, 0);
  EXPECT_TRUE(fs::exists(file("film/frame_0000.png")));
  EXPECT_EQ(run("render room.glb -o room.png --width 64 --height 48 --wireframe --eye 278,273,-700").status, 0);
  EXPECT_TRUE(fs::exists(file("room.png")));
}

TEST_F(Command, RenderOptionsThatCannotBeMeantAreUsageErrors) {
  ASSERT_EQ(run("solve " + cornell_box + quick + " -o room.glb").status, 0);
  for (const std::string option :
       {"--false-colour --range 3,1", "--false-colour --range 3", "--false-colour --range 0,1 --log-scale",
        "--false-colour --band x", "--false-colour --exposure 1", "--false-colour --show error", "--show error --exposure 1",
        "--show noise", "--band r", "--range 0,1", "--log-scale", "--ambient", "--eye 1,2,3 --target 1,2,3"}) {
    const Ran ran = run("render room.glb -o room.png " + option);
    EXPECT_EQ(ran.status, 2) << option;
    EXPECT_EQ(line_count(ran.err), 1) << ran.err;
    EXPECT_FALSE(fs::exists(file("room.png"))) << option;
  }
}

TEST_F(Command, RenderOfASolveWithoutAServerAsksForOne) {
  const Ran ran = run("render scenes/a/solves/b -o room.png");
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.err.find("--server"), std::string::npos) << ran.err;
}

TEST_F(Command, RenderOfASolveOnAnUnreachableServerHasItsOwnStatus) {
  EXPECT_EQ(run("render scenes/a/solves/b -o room.png --server 127.0.0.1:1").status, 4);
}

TEST_F(Command, ErrorsAreDrawnWhereTheSolutionTellsThem) {
  ASSERT_EQ(run("solve " + cornell_box + quick + " -o room.glb").status, 0);
  const std::string size = " --width 240 --height 180";
  ASSERT_EQ(run("render room.glb -o error.png --show error --log-scale" + size).status, 0);
  ASSERT_EQ(run("render room.glb -o light.png --show irradiance" + size).status, 0);
  ASSERT_EQ(run("render room.glb -o colour.png --false-colour" + size).status, 0);
  EXPECT_EQ(text_of(file("light.png")), text_of(file("colour.png")));
  EXPECT_NE(text_of(file("light.png")), text_of(file("error.png")));
}

TEST_F(Command, FalseColourIsSpelledBothWays) {
  ASSERT_EQ(run("solve " + cornell_box + quick + " -o room.glb").status, 0);
  const std::string options = " --width 240 --height 180 --wireframe --log-scale --band g";
  ASSERT_EQ(run("render room.glb -o colour.png --false-colour" + options).status, 0);
  ASSERT_EQ(run("render room.glb -o color.png --false-color" + options).status, 0);
  EXPECT_EQ(text_of(file("colour.png")), text_of(file("color.png")));
}

/// Returns a mirror at `revision`, with one root patch.
SolutionMirror mirror_at(std::uint64_t revision) {
  SolutionMirror mirror;
  Step step;
  step.revision = revision;
  Delta delta;
  delta.to_revision = delta.head = revision;
  delta.values = {{PatchId::root(0), {1, 1, 1}}};
  delta.steps = {step};
  EXPECT_FALSE(mirror.apply(delta));
  return mirror;
}

TEST(Snapshots, AreThinnedEvenlyAndEndWithTheLastState) {
  Snapshots snapshots;
  for (std::uint64_t revision = 1; revision <= 1000; ++revision) snapshots.offer(mirror_at(revision));
  const std::vector<Snapshot> kept = snapshots.take(mirror_at(1001));
  EXPECT_GE(kept.size(), Snapshots::most / 2);
  EXPECT_LE(kept.size(), Snapshots::most + 1);
  EXPECT_EQ(kept.front().revision, 1u);
  EXPECT_EQ(kept.back().revision, 1001u);
  for (std::size_t i = 2; i + 1 < kept.size(); ++i)
    EXPECT_EQ(kept[i].revision - kept[i - 1].revision, kept[1].revision - kept[0].revision);
}

// A unit cube seen from inside: the form factor between any two faces is 0.2 to the third digit (0.19982 and 0.20004).
const std::string cube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n";

TEST_F(Command, FormFactorIsGivenByEveryMethodWithItsBound) {
  write("cube.obj", cube);
  const Ran ran = run("form-factor cube.obj 0 1 --json");
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto methods = nlohmann::json::parse(ran.out);
  ASSERT_EQ(methods.size(), 4u);
  for (const auto& method : methods)
    EXPECT_NEAR(method.at("value").get<double>(), 0.199825, method.at("error_bound").get<double>() + 1e-6);
}

TEST_F(Command, FormFactorOfAFaceThatIsNotThereIsAUsageError) {
  write("cube.obj", cube);
  EXPECT_EQ(run("form-factor cube.obj 0 6").status, 2);
  EXPECT_EQ(run("form-factor missing.obj 0 1").status, 3);
}

TEST_F(Command, FormFactorMatrixHasALinePerPairThatSeesEachOther) {
  write("cube.obj", cube);
  ASSERT_EQ(run("form-factors cube.obj -o F.csv").status, 0);
  const std::string csv = text_of(file("F.csv"));
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "i,j,F,error_bound,area_i");
  EXPECT_EQ(line_count(csv), 31);
  EXPECT_FALSE(std::filesystem::exists(file("F.csv.part")));
}

TEST_F(Command, WhatASceneNeedsIsExplained) {
  const Ran ran = run("explain " + cornell_box + " --max-depth 0");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.out.find("refinement       off"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("three bands      on"), std::string::npos) << ran.out;
}

TEST_F(Command, PlansAreJsonOnDemand) {
  const Ran ran = run("explain --json --absorption 1,1,1 " + cornell_box);
  ASSERT_EQ(ran.status, 0) << ran.err;
  const auto plan = nlohmann::json::parse(ran.out);
  const auto medium = std::ranges::find_if(plan, [](const auto& planned) { return planned.at("feature") == "medium"; });
  ASSERT_NE(medium, plan.end());
  EXPECT_TRUE(medium->at("on"));
  EXPECT_NE(medium->at("reason").get<std::string>().find("1 1 1 per metre"), std::string::npos);
}

TEST_F(Command, LawsOfFormFactorsAreMeasured) {
  write("cube.obj", cube);
  const Ran ran = run("explain --form-factors cube.obj");
  EXPECT_EQ(ran.status, 0) << ran.err;
  for (const std::string law : {"reciprocity", "additivity", "closure"}) EXPECT_NE(ran.out.find(law), std::string::npos);
}

TEST_F(Command, AMediumDimsTheRoom) {
  const auto light = [&](const std::string& options) {
    EXPECT_EQ(run("solve " + cornell_box + quick + options + " -o room.glb").status, 0);
    EXPECT_EQ(run("probe room.glb --points " + points + " -o values.csv").status, 0);
    std::istringstream lines(text_of(file("values.csv")));
    std::string line;
    std::getline(lines, line);
    double sum = 0;
    while (std::getline(lines, line)) {
      for (int comma = 0; comma < 6; ++comma) line.erase(0, line.find(',') + 1);
      sum += std::stod(line);
    }
    return sum;
  };
  EXPECT_LT(light(" --absorption 0.001,0,0"), 0.8 * light(""));
  EXPECT_EQ(run("solve " + cornell_box + " --absorption -1,0,0").status, 2);
}

}  // namespace
}  // namespace alvor
