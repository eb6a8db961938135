// Tests of `alvor`'s messages about wrong command lines.

#include "radiosity/plan/solve_options.h"
#include "tests/command_line.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>
#include <string>

namespace alvor {
namespace {

const std::string cornell_box = ALVOR_SCENES "/cornell_box.obj";

using Usage = test::CommandLine;
using test::Ran;
namespace fs = std::filesystem;

TEST_F(Usage, TheVersionIsOneLine) {
  const Ran ran = run("--version");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(ran.out, "alvor " ALVOR_VERSION "\n");
}

TEST_F(Usage, HelpTellsTheDefaultsOfTheServer) {
  const SolveOptions defaults;
  const std::string help = run("solve --help").out;
  std::ostringstream tolerance;
  tolerance << defaults.tolerance;
  for (const std::string& told :
       {"error is this small (" + tolerance.str() + ")", "no refinement (" + std::to_string(defaults.max_depth) + ")",
        "this many leaves (" + std::to_string(defaults.max_leaves) + ")",
        "same solution (" + std::to_string(defaults.seed) + ")"})
    EXPECT_NE(help.find(told), std::string::npos) << told;
}

TEST_F(Usage, MisspeltCommandsAreSetRight) {
  const Ran ran = run("sovle room.obj --tolerance 0.1");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "alvor: there is no command 'sovle'; did you mean 'solve'?\n");
  EXPECT_EQ(run("solves lst --server 127.0.0.1:1").err, "alvor solves: there is no command 'lst'; did you mean 'list'?\n");
  EXPECT_EQ(run("form-facters room.obj").err, "alvor: there is no command 'form-facters'; did you mean 'form-factors'?\n");
}

TEST_F(Usage, CommandsLikeNoneGetNoSuggestion) {
  const Ran ran = run("photograph");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "alvor: there is no command 'photograph' (see alvor --help)\n");
}

TEST_F(Usage, UnknownOptionsNameTheCommandAndWhatMayBeMeant) {
  const Ran ran = run("solve " + cornell_box + " --tolerence 0.1");
  EXPECT_EQ(ran.status, 2);
  EXPECT_EQ(ran.err, "alvor solve: there is no option --tolerence; did you mean --tolerance?\n");
  EXPECT_EQ(run("solve room.obj --tol=0.1").err, "alvor solve: there is no option --tol; did you mean --tolerance?\n");
  EXPECT_EQ(run("render room.glb --ouput room.png").err, "alvor render: there is no option --ouput; did you mean --output?\n");
  EXPECT_EQ(run("probe room.glb --flash").err, "alvor probe: there is no option --flash (see alvor probe --help)\n");
  EXPECT_EQ(run("--verion").err, "alvor: there is no option --verion; did you mean --version?\n");
  EXPECT_EQ(run("--flash solve room.obj").err, "alvor: there is no option --flash (see alvor --help)\n");
}

TEST_F(Usage, OtherFaultsNameTheCommandToo) {
  EXPECT_EQ(run("explain a.obj b.obj").err, "alvor explain: 'b.obj' is one argument too many (see alvor explain --help)\n");
  EXPECT_TRUE(run("solve room.obj --tolerance 2").err.starts_with("alvor solve: --tolerance: 2 is not"));
}

TEST_F(Usage, SuffixesOfOtherFormatsAreRefusedBeforeAnyWork) {
  const auto refusal = [&](const std::string& arguments) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 2) << arguments;
    return ran.err;
  };
  EXPECT_EQ(refusal("solve missing.obj -o room.jpg"), "alvor: --output room.jpg: a solution file ends in .glb, .ply, .alvor or .vtu\n");
  EXPECT_EQ(refusal("render missing.glb -o picture.glb"), "alvor: --output picture.glb: a picture ends in .png\n");
  EXPECT_EQ(refusal("probe missing.glb --points missing.csv -o values.png"),
            "alvor: --output values.png: a table ends in .csv or .txt\n");
  EXPECT_EQ(refusal("form-factors missing.obj -o F.png"), "alvor: --output F.png: a table ends in .csv or .txt\n");
  EXPECT_EQ(refusal("solve missing.obj --report report.xls"), "alvor: --report report.xls: a table ends in .csv or .txt\n");
  EXPECT_EQ(refusal("verify missing.obj missing.glb --csv v.png"), "alvor: --csv v.png: a table ends in .csv or .txt\n");
  EXPECT_EQ(refusal("verify missing.obj missing.glb --picture e.jpg"), "alvor: --picture e.jpg: a picture ends in .png\n");
}

TEST_F(Usage, BakedErrorsAreFilesOfLightmapsThatAreToldErrors) {
  const auto refusal = [&](const std::string& arguments, int status) {
    const Ran ran = run("bake --errors --quiet --size 64 " + arguments);
    EXPECT_EQ(ran.status, status) << arguments;
    return ran.err;
  };
  EXPECT_EQ(refusal("--as vertex " + cornell_box + " -o b.glb", 2), "alvor: --errors: only --as lightmap has lightmaps\n");
  EXPECT_EQ(refusal("--as unlit " + cornell_box + " -o b.glb", 2), "alvor: --errors: only --as lightmap has lightmaps\n");
  EXPECT_EQ(refusal(cornell_box + " -o -", 2), "alvor: --output: errors are files beside the scene, so it cannot go to stdout\n");
  write("dark.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  EXPECT_NE(refusal("dark.obj -o b.glb", 3).find("alvor: dark.obj: tells no errors: no surface has any light"), std::string::npos);
  EXPECT_FALSE(fs::exists(file("b.glb")));
}

TEST_F(Usage, SuffixesMayBeInCapitals) {
  EXPECT_EQ(run("solve " + cornell_box + " --tolerance 0.3 --max-depth 2 -o ROOM.GLB").status, 0);
  EXPECT_TRUE(fs::exists(file("ROOM.GLB")));
}

TEST_F(Usage, QuietLeavesWarningsResultsAndErrors) {
  write("dark.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  for (const std::string arguments :
       {"solve dark.obj -o dark.glb --quiet", "--quiet solve dark.obj -o dark.glb", "form-factors dark.obj -o F.csv -q"}) {
    const Ran ran = run(arguments);
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_EQ(ran.out, "") << arguments;
    std::istringstream lines(ran.err);
    for (std::string line; std::getline(lines, line);) EXPECT_TRUE(line.starts_with("warning: ")) << line;
  }
  EXPECT_NE(run("solve dark.obj -o dark.glb --quiet").err, "") << "it has no emitter";
  EXPECT_TRUE(run("solve dark.obj --quiet --json").out.starts_with("{")) << "what was asked for is no remark";
  EXPECT_NE(run("explain dark.obj --quiet").out, "");
  EXPECT_NE(run("solve missing.obj --quiet").err, "");
}

TEST_F(Usage, EveryCommandKnowsQuiet) {
  for (const std::string command :
       {"solve", "watch", "probe", "render", "verify", "compare", "explain", "form-factor", "form-factors", "scenes list",
        "scenes delete", "solves list", "solves get", "solves cancel", "solves pause", "solves resume", "solves delete"})
    EXPECT_NE(run(command + " --help").out.find("--quiet"), std::string::npos) << command;
}

}  // namespace
}  // namespace alvor
