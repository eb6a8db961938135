// How much of a solve a bar of progress says is done.

#include "client/command/output/done_share.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

TEST(DoneShare, DoesNotGoBackWhereTheEstimateRises) {
  DoneShare share({.tolerance = 0.01});
  EXPECT_EQ(share.after({.estimated_error = 1}), 0);
  const double half = share.after({.estimated_error = 0.1});
  EXPECT_NEAR(half, 0.5, 1e-12);
  EXPECT_EQ(share.after({.estimated_error = 0.4}), half);
  EXPECT_GT(share.after({.estimated_error = 0.05}), half);
  EXPECT_EQ(share.after({.estimated_error = 0.01}), 1);
}

TEST(DoneShare, BeginsAnewAfterAnEdit) {
  DoneShare share({.tolerance = 0.01});
  share.after({.estimated_error = 0.005});
  EXPECT_NEAR(share.after({.estimated_error = 0.1, .edits = 1}), 0.5, 1e-12);
}

TEST(DoneShare, IsNothingWhileAnEditIsOnlyShown) {
  for (const ProgressGoal goal : {ProgressGoal{0.05, 0.8}, ProgressGoal{0.05, 0}}) {
    DoneShare share(goal);
    share.after({.estimated_error = 0.01, .area_within = 0.9});
    EXPECT_EQ(share.after({.estimated_error = 0.01, .area_within = 0.9, .edits = 1, .is_provisional = true}), 0);
  }
}

TEST(DoneShare, IsOfTheAreaWhereATolerancePerPlaceIsAskedFor) {
  DoneShare share({.tolerance = 0.05, .area_share = 0.8});
  EXPECT_EQ(share.after({.estimated_error = 0.01, .area_within = 0}), 0);
  EXPECT_EQ(share.after({.estimated_error = 0.2, .area_within = 0.4}), 0.5);
  EXPECT_EQ(share.after({.estimated_error = 0.2, .area_within = 0.9}), 1);
}

}  // namespace
}  // namespace alvor
