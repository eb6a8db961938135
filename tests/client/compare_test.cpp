// Tests the command `alvor compare` as users see it.

#include "tests/command_line.h"

namespace alvor {
namespace {

using CompareCommand = test::CommandLine;
using test::Ran;
namespace fs = std::filesystem;

const std::string quick = "compare " ALVOR_SCENES "/cornell_box.obj --tolerance 0.3 --steps 10 -o ";

TEST_F(CompareCommand, WritesTableScriptAndPictures) {
  const Ran ran = run(quick + "found");
  ASSERT_EQ(ran.status, 0) << ran.err;
  for (const std::string name : {"compare.csv", "compare.gnuplot", "gather.png", "shoot.png", "sorted.png", "sorted+ambient.png",
                                 "overshoot.png", "converged.png"})
    EXPECT_TRUE(fs::exists(file("found/" + name))) << name;
  const std::string table = test::text_of(file("found/compare.csv"));
  EXPECT_TRUE(table.starts_with("strategy,steps,cpu_s,rms_error\n")) << table.substr(0, 100);
  for (const std::string strategy : {"gather", "shoot", "sorted", "sorted+ambient", "overshoot"})
    EXPECT_NE(table.find("\n" + strategy + ",10,"), table.npos) << strategy;
  EXPECT_NE(ran.out.find("overshoot"), ran.out.npos) << ran.out;
}

TEST_F(CompareCommand, PlotsAreDrawnByGnuplotOrSkippedInOneLine) {
  const Ran ran = run(quick + "found");
  const bool says_skipped = ran.err.find("plots were skipped") != ran.err.npos;
  for (const std::string plot : {"rms_per_step.png", "rms_per_second.png"})
    EXPECT_EQ(fs::exists(file("found/" + plot)), !says_skipped) << plot;

  const std::string path = std::getenv("PATH");
  setenv("PATH", "/nowhere", 1);
  const Ran without = run(quick + "skipped");
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(without.status, 0) << without.err;
  EXPECT_NE(without.err.find("plots were skipped"), without.err.npos) << without.err;
  EXPECT_TRUE(fs::exists(file("skipped/compare.gnuplot")));
  EXPECT_FALSE(fs::exists(file("skipped/rms_per_step.png")));
}

TEST_F(CompareCommand, FailsWithTheStatusesOfTheOthers) {
  EXPECT_EQ(run("compare " ALVOR_SCENES "/cornell_box.obj").status, 2);
  EXPECT_EQ(run(quick + "found --steps 0").status, 2);
  write("file", "not a folder\n");
  EXPECT_EQ(run(quick + "file").status, 2);
  EXPECT_EQ(run("compare missing.obj -o found").status, 3);
  write("dark.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  const Ran dark = run("compare dark.obj -o found");
  EXPECT_EQ(dark.status, 3);
  EXPECT_NE(dark.err.find("alvor: dark.obj: nothing emits light"), dark.err.npos) << dark.err;
}

TEST_F(CompareCommand, StrategiesThatItComparesCanSolve) {
  for (const std::string strategy : {"auto", "gather", "shoot", "sorted", "sorted+ambient", "overshoot"}) {
    const Ran ran = run("solve " ALVOR_SCENES "/cornell_box.obj --tolerance 0.3 --max-depth 2 --strategy " + strategy);
    EXPECT_EQ(ran.status, 0) << strategy << ": " << ran.err;
    EXPECT_NE(ran.out.find("depth limit reached") == ran.out.npos, ran.out.find("tolerance reached") == ran.out.npos) << ran.out;
  }
}

}  // namespace
}  // namespace alvor
