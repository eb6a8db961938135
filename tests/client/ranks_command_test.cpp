// Tests `alvor` under mpirun: several processes give what one gives.

#include "tests/command_line.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

using test::Ran;
using test::text_of;

class RanksOfACommand : public test::CommandLine {
 protected:
  /// More ranks than this machine may have cores, whoever runs the tests.
  Ran run_on(int ranks, const std::string& arguments) const {
    return run_with(
        "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun --oversubscribe -n " + std::to_string(ranks),
        arguments);
  }
};

struct OneScene {
  std::string name, options;
};

void PrintTo(const OneScene& one, std::ostream* out) { *out << one.name; }

class EqualBytes : public RanksOfACommand, public testing::WithParamInterface<OneScene> {};
INSTANTIATE_TEST_SUITE_P(Scenes, EqualBytes,
                         testing::Values(OneScene{"cornell_box", "--tolerance 0.02"},
                                         OneScene{"furnished_room", "--tolerance 0.06"},
                                         OneScene{"slats_and_boxes", "--tolerance 0.08"},
                                         OneScene{"enfilade", "--tolerance 0.05"}, OneScene{"vault", "--tolerance 0.05"},
                                         OneScene{"louvred_room", "--tolerance 0.2 --max-elements 20000"}),
                         [](const auto& one) { return one.param.name; });

TEST_P(EqualBytes, OfOneToFourRanks) {
  const std::string solve = "solve " ALVOR_SCENES "/" + GetParam().name + ".obj " + GetParam().options + " -o ";
  ASSERT_EQ(run(solve + "alone.glb").status, 0);
  const std::string alone = text_of(file("alone.glb"));
  ASSERT_GT(alone.size(), 10'000u);
  for (const int ranks : {2, 3, 4}) {
    const Ran ran = run_on(ranks, solve + "several.glb");
    EXPECT_EQ(ran.status, 0) << ran.err;
    EXPECT_TRUE(text_of(file("several.glb")) == alone) << ranks << " ranks";
  }
}

TEST_F(RanksOfACommand, BakeTheSameLight) {
  const std::string bake = "bake " ALVOR_SCENES "/cornell_box.obj --size 128 -o ";
  ASSERT_EQ(run(bake + "alone.glb").status, 0);
  const Ran ran = run_on(2, bake + "several.glb");
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_TRUE(text_of(file("several.glb")) == text_of(file("alone.glb")));
}

TEST_F(RanksOfACommand, OnlyTheFirstSpeaks) {
  const Ran ran = run_on(3, "--version");
  EXPECT_EQ(ran.status, 0);
  EXPECT_EQ(test::line_count(ran.out), 1) << ran.out;
}

TEST_F(RanksOfACommand, AFaultEndsAllOfThem) {
  const Ran ran = run_on(2, "solve missing.obj");
  EXPECT_EQ(ran.status, 3);
  EXPECT_NE(ran.err.find("missing.obj: file: does not exist"), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace alvor
