#include "solution/solution_log.h"

#include <gtest/gtest.h>

#include <thread>

namespace alvor {
namespace {

const PatchId root = PatchId::root(0);

LeafValue value(PatchId patch, float x) { return {patch, {x, 2 * x, 3 * x}}; }

std::vector<LeafValue> children(PatchId patch, float x) {
  return {value(patch.child(0), x), value(patch.child(1), x), value(patch.child(2), x), value(patch.child(3), x)};
}

TEST(SolutionLog, KeepsTheNewestValueOfEachLeaf) {
  SolutionLog log;
  log.publish(std::vector{value(root, 1)}, {});
  log.publish(std::vector{value(root, 2)}, {});
  EXPECT_EQ(log.head(), 2u);
  EXPECT_EQ(log.leaves(), std::vector{value(root, 2)});
}

TEST(SolutionLog, SplitReplacesTheAncestor) {
  SolutionLog log;
  log.publish(std::vector{value(root, 1)}, {});
  log.publish(children(root, 2), {});
  EXPECT_EQ(log.leaves(), children(root, 2));
}

TEST(SolutionLog, AValueOfACoarserPatchMakesTheLeavesInItOne) {
  SolutionLog log;
  log.publish(children(root, 1), {});
  log.publish(children(root.child(1), 2), {}, std::vector{1.0f, 1.0f, 1.0f, 1.0f});
  log.publish(std::vector{value(root, 7)}, {}, std::vector{0.5f});
  EXPECT_EQ(log.leaves(), std::vector{value(root, 7)});
  EXPECT_EQ(log.since({.base = 2}).values, std::vector{value(root, 7)});
  const Delta delta = log.since({.errors = {.are_wanted = true}});
  ASSERT_TRUE(delta.errors);
  for (const std::uint8_t code : delta.errors->codes) EXPECT_NEAR(delta.errors->coding.unpack(code), 0.5, 0.03);
}

TEST(SolutionLog, CoarserAndFinerPatchesComeTogether) {
  SolutionLog log;
  log.publish(children(root, 1), {});
  log.publish(children(root.child(1), 2), {});
  std::vector<LeafValue> mixed = children(root.child(0), 3);
  mixed.push_back(value(root.child(1), 4));
  mixed.push_back(value(root.child(2), 5));
  mixed.push_back(value(root.child(3), 6));
  log.publish(mixed, {});
  std::vector<float> values;
  for (const LeafValue& leaf : log.leaves()) values.push_back(leaf.irradiance.r);
  EXPECT_EQ(values, (std::vector<float>{3, 3, 3, 3, 4, 5, 6}));
  EXPECT_EQ(log.since({.base = 2}).state_hash, log.since({}).state_hash);
}

TEST(SolutionLog, TellsTheEditsOfTheStateBeforeADelta) {
  SolutionLog log;
  log.publish(std::vector{value(root, 1)}, {});
  log.publish(std::vector{value(root, 2)}, {.edits = 4});
  EXPECT_EQ(log.since({}).edits_before, 0u);
  EXPECT_EQ(log.since({.base = 1}).edits_before, 0u);
  EXPECT_EQ(log.since({.base = 2}).edits_before, 4u);
}

TEST(SolutionLog, GoesOnAfterItWasReopened) {
  SolutionLog log;
  log.publish(std::vector{value(root, 1)}, {});
  log.close();
  log.reopen();
  EXPECT_FALSE(log.closed());
  log.publish(std::vector{value(root, 2)}, {});
  EXPECT_EQ(log.head(), 2u);
}

TEST(SolutionLog, SinceGivesOnlyWhatChanged) {
  SolutionLog log;
  log.publish(children(root, 1), {});
  log.publish(std::vector{value(root.child(2), 5)}, {});
  const Delta delta = log.since({.base = 1});
  EXPECT_EQ(delta.values, std::vector{value(root.child(2), 5)});
  EXPECT_EQ(delta.from_revision, 1u);
  EXPECT_EQ(delta.to_revision, 2u);
  EXPECT_TRUE(delta.whole());
  EXPECT_TRUE(log.since({.base = 2}).values.empty());
}

TEST(SolutionLog, SinceCarriesEveryStepOfTheSpan) {
  SolutionLog log;
  for (int n = 1; n <= 5; ++n) log.publish(std::vector{value(root, float(n))}, {.shots = std::uint64_t(n)});
  const Delta delta = log.since({.base = 2});
  ASSERT_EQ(delta.steps.size(), 3u);
  EXPECT_EQ(delta.steps.front().revision, 3u);
  EXPECT_EQ(delta.steps.front().step, 2u);
  EXPECT_EQ(delta.steps.back().shots, 5u);
}

TEST(SolutionLog, PagesWithinOneRevisionAddUpToTheWhole) {
  SolutionLog log;
  std::vector<LeafValue> all;
  for (std::uint32_t r = 0; r < 25; ++r)
    for (const LeafValue& leaf : children(PatchId::root(r), float(r))) all.push_back(leaf);
  log.publish(all, {});
  std::vector<LeafValue> got;
  Cursor cursor;
  for (Delta delta = log.since(cursor, Detail::exact, 7);; delta = log.since(cursor, Detail::exact, 7)) {
    EXPECT_EQ(delta.from_revision, 0u);
    got.insert(got.end(), delta.values.begin(), delta.values.end());
    cursor = delta.next;
    if (delta.whole()) break;
    EXPECT_EQ(delta.to_revision, 0u);
  }
  EXPECT_EQ(got, all);
}

TEST(SolutionLog, ListenersHearEveryPublicationUntilForgotten) {
  SolutionLog log;
  int heard = 0;
  const auto handle = log.listen([&] { ++heard; });
  log.publish(std::vector{value(root, 1)}, {});
  log.close();
  EXPECT_EQ(heard, 2);
  log.forget(handle);
  log.publish(std::vector{value(root, 2)}, {});
  EXPECT_EQ(heard, 2);
}

TEST(SolutionLog, WaitersWakeOnPublishAndClose) {
  SolutionLog log;
  std::jthread writer([&] {
    log.publish(std::vector{value(root, 1)}, {});
    log.close();
  });
  log.wait_beyond(0);
  EXPECT_GE(log.head(), 1u);
  log.wait_beyond(100);
  EXPECT_TRUE(log.closed());
}

TEST(SolutionLog, ValuesThatDoNotChangeAreNotToldAgain) {
  SolutionLog log;
  log.publish(children(root, 1), {});
  log.publish(children(root, 1), {});
  EXPECT_TRUE(log.since({.base = 1}).values.empty());
  EXPECT_TRUE(log.since({.base = 1}).whole());
}

TEST(SolutionLog, DisplayIsToldAgainWhenItIsOffByMoreThanAllowed) {
  SolutionLog log;
  const Step step{.displayed_error = 0.1};
  const auto told = [&](float x) {
    const std::uint64_t before = log.head();
    log.publish(std::vector{value(root, x)}, step);
    return !log.since({.base = before}, Detail::display).values.empty();
  };
  EXPECT_TRUE(told(1));
  EXPECT_FALSE(told(1.06f));
  EXPECT_FALSE(told(1.1f));
  EXPECT_TRUE(told(1.2f)) << "it has crept away from what was told";
  EXPECT_FALSE(told(1.25f));
  EXPECT_EQ(log.leaves(), std::vector{value(root, 1.25f)});
  EXPECT_NEAR(log.leaves(Detail::display)[0].irradiance.b, 3.75, 0.1 * 3.75);
}

TEST(SolutionLog, DisplayHoldsWhatBecomesTooBrightForItsScale) {
  SolutionLog log;
  log.publish(children(root, 1e-20f), {});
  log.publish(std::vector{value(root.child(3), 1e20f)}, {});
  const auto shown = log.leaves(Detail::display);
  EXPECT_NEAR(shown[3].irradiance.b / 3e20, 1, 0.002);
  EXPECT_EQ(log.since({.base = 1}, Detail::display).values.size(), 4u) << "the scale is another";
}

TEST(SolutionLog, OneNewLeafSplitsAndItsSiblingsInherit) {
  SolutionLog log;
  log.publish(std::vector{value(root, 1)}, {});
  log.publish(std::vector{value(root.child(2), 7)}, {});
  EXPECT_EQ(log.leaves(),
            (std::vector{value(root.child(0), 1), value(root.child(1), 1), value(root.child(2), 7), value(root.child(3), 1)}));
  EXPECT_EQ(log.since({.base = 1}).values.size(), 1u) << "a mirror implies the others by itself";
}

}  // namespace
}  // namespace alvor
