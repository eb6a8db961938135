#include "tests/vectors/vectors.h"
#include "proto/codec.h"
#include "solution/solution_mirror.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

class Vectors : public testing::TestWithParam<const char*> {};

TEST_P(Vectors, LeadToTheSameLeavesInEveryMirror) {
  const std::string path = std::string(ALVOR_VECTORS) + "/" + GetParam();
  SolutionMirror mirror;
  const auto frames = vectors::read_frames(path + ".frames");
  ASSERT_FALSE(frames.empty());
  for (const v1::WatchSolveResponse& frame : frames) {
    Delta delta;
    ASSERT_FALSE(decode(frame, delta));
    ASSERT_EQ(mirror.apply(delta), std::nullopt);
  }
  EXPECT_EQ(frames.back().look().edits(), mirror.edits()) << "no look where there are no edits";
  EXPECT_EQ(vectors::bytes_of(mirror.leaves()), vectors::read(path + ".leaves"));
  EXPECT_EQ(vectors::bytes_of(mirror.errors()), vectors::read(path + ".errors")) << "none, if there is no such file";
}

INSTANTIATE_TEST_SUITE_P(All, Vectors,
                         testing::Values("display", "exact", "deep", "one_page", "uneven", "errors", "merges", "slabs", "edits"),
                         [](const auto& vector) { return std::string(vector.param); });

}  // namespace
}  // namespace alvor
