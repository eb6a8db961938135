#include "server/base/memory_guard.h"

#include "server/solves/solve_store.h"
#include "tests/server/refusal.h"
#include "tests/server/sample_scenes.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace alvor {
namespace {

constexpr std::uint64_t mebibyte = 1 << 20;
std::atomic<std::uint64_t> used = 0;
std::uint64_t used_memory() { return used; }

TEST(MemoryGuard, AdmitsUpToThreeQuartersAndIsShortBeyondSevenEighths) {
  const MemoryGuard guard(800 * mebibyte, used_memory);
  used = 400 * mebibyte;
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { guard.admit("scene", 200 * mebibyte); }), "");
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { guard.admit("scene", 201 * mebibyte); }),
            "scene: needs about 201 MiB of memory; 400 MiB of 800 MiB are in use");
  used = 601 * mebibyte;
  EXPECT_FALSE(guard.has_room(0));
  used = 700 * mebibyte;
  EXPECT_FALSE(guard.is_short());
  used = 701 * mebibyte;
  EXPECT_TRUE(guard.is_short());
}

TEST(MemoryGuard, OfSmallLimitsAsMuchStaysFreeAsAnEndingSolveTakes) {
  const MemoryGuard guard(256 * mebibyte, used_memory);
  used = 192 * mebibyte;
  EXPECT_FALSE(guard.is_short());
  used = 192 * mebibyte + 1;
  EXPECT_TRUE(guard.is_short());
  used = 164 * mebibyte;
  EXPECT_TRUE(guard.has_room(0));
  used = 165 * mebibyte;
  EXPECT_FALSE(guard.has_room(0));
  used = 0;
}

TEST(MemoryGuard, OfTheSmallestLimitsAQuarterStaysFree) {
  const MemoryGuard guard(80 * mebibyte, used_memory);
  used = 60 * mebibyte;
  EXPECT_FALSE(guard.is_short());
  used = 61 * mebibyte;
  EXPECT_TRUE(guard.is_short());
  used = 0;
}

TEST(MemoryGuard, WithoutALimitThereIsAlwaysRoom) {
  EXPECT_TRUE(MemoryGuard().has_room(~std::uint64_t{0}));
  EXPECT_FALSE(MemoryGuard().is_short());
}

TEST(MemoryGuard, SomethingIsAllowedAndLessIsResident) {
  EXPECT_GT(resident_bytes(), 0u);
  EXPECT_GT(allowed_memory(), resident_bytes());
}

TEST(MemoryGuard, ResidentBytesAreThoseThatWereTaken) {
  const std::uint64_t before = resident_bytes();
  const std::vector<char> taken(64 * mebibyte, 'x');
  EXPECT_NEAR(static_cast<double>(resident_bytes() - before), static_cast<double>(taken.size()), 8.0 * mebibyte);
}

/// A solver that runs until it is told to end, and then frees memory.
SolveOutcome wait_for_end(const SceneContent&, const Plan&, const SolveOptions&, SolutionLog& log, const SolveControl& control) {
  log.publish(std::vector<LeafValue>{{PatchId::root(0), {1, 2, 3}}}, {});
  while (!control.short_of_memory.stop_requested() && !control.stop.stop_requested()) std::this_thread::yield();
  if (control.stop.stop_requested()) return {.reason = StopReason::cancelled};
  used = 0;
  return {.reason = StopReason::memory};
}

class ShortMemoryTest : public testing::Test {
 protected:
  static SolveStoreOptions options() {
    SolveStoreOptions options;
    options.solver = wait_for_end;
    options.memory = MemoryGuard(800 * mebibyte, used_memory);
    return options;
  }
  static void SetUpTestSuite() { used = 0; }
  std::shared_ptr<StoredSolve> create(SolvePriority priority) { return solves.create(scenes.use(scene), {.priority = priority}); }

  SceneStore scenes;
  std::string scene = scenes.add(squares(2), "")->facts.name;
  SolveStore solves{options(), scenes};
};

TEST_F(ShortMemoryTest, LastAndLeastSolveEndsWithWhatItHas) {
  const auto low = create(SolvePriority::low), first = create(SolvePriority::normal), last = create(SolvePriority::normal);
  for (const auto& solve : {low, first, last})
    while (solve->log()->head() == 0) std::this_thread::yield();
  used = 790 * mebibyte;
  while (!low->ended()) std::this_thread::yield();
  EXPECT_EQ(low->describe().end_reason, "memory limit reached");
  EXPECT_EQ(low->status(), SolveStatus::succeeded);
  EXPECT_EQ(low->log()->head(), 1u);
  EXPECT_FALSE(last->ended());
  used = 790 * mebibyte;
  while (!last->ended()) std::this_thread::yield();
  EXPECT_FALSE(first->ended());
  used = 650 * mebibyte;
  EXPECT_NE(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { create(SolvePriority::high); }).find("of memory"), std::string::npos);
  used = 0;
  EXPECT_EQ(create(SolvePriority::high)->status(), SolveStatus::running);
}

TEST_F(ShortMemoryTest, OfTheTenantWhoTakesMostASolveEndsFirst) {
  const std::string bobs = scenes.add(squares(2), "", {"bob", ""})->facts.name;
  const auto of_one = solves.create(scenes.use(bobs, "bob"), {}, {"bob", ""});
  const auto first = create(SolvePriority::normal), second = create(SolvePriority::normal);
  const auto last = solves.create(scenes.use(bobs, "bob"), {}, {"bob", ""});
  solves.cancel(last->name, "bob");
  for (const auto& solve : {of_one, first, second})
    while (solve->log()->head() == 0) std::this_thread::yield();
  while (!last->ended()) std::this_thread::yield();
  used = 790 * mebibyte;
  while (!second->ended()) std::this_thread::yield();
  EXPECT_FALSE(of_one->ended());
  EXPECT_FALSE(first->ended());
  used = 0;
}

TEST(MemoryGuard, WhatNobodyNeedsIsGivenBackBeforeAnythingIsRefused) {
  const MemoryGuard guard(800 * mebibyte, used_memory);
  used = 650 * mebibyte;
  {
    const auto handle = guard.relieve_by([] { used = 100 * mebibyte; });
    EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { guard.admit("scene", 100 * mebibyte); }), "");
  }
  const MemoryGuard other(800 * mebibyte, used_memory);
  (void)other.relieve_by([] { used = 0; });  // unregistered at once
  used = 650 * mebibyte;
  EXPECT_NE(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { other.admit("scene", 100 * mebibyte); }), "");
  used = 0;
}

TEST(MemoryGuard, WorkDoesNotWaitForThePauseOfThoseWhoLookAgainAndAgain) {
  const MemoryGuard guard(800 * mebibyte, used_memory);
  static std::atomic<int> reliefs;
  reliefs = 0;
  const auto handle = guard.relieve_by([] { ++reliefs; });
  used = 650 * mebibyte;
  for (int n = 0; n < 3; ++n) EXPECT_FALSE(guard.runs_short());
  EXPECT_EQ(reliefs, 1);
  while (reliefs < 2) guard.make_room(0);  // a moment later
  used = 790 * mebibyte;
  while (reliefs < 3) EXPECT_TRUE(guard.runs_short());  // nor does who would end work
  used = 650 * mebibyte;
  guard.expect_gain();
  EXPECT_FALSE(guard.runs_short());
  EXPECT_EQ(reliefs, 4);
  used = 0;
  EXPECT_FALSE(guard.runs_short());
  guard.make_room(100 * mebibyte);
  EXPECT_EQ(reliefs, 4) << "there is room";
}

TEST(MemoryGuard, SomethingElseEndsBeforeASolve) {
  used = 0;
  SceneStore scenes;
  const std::string scene = scenes.add(squares(2), "")->facts.name;
  SolveStoreOptions options;
  options.solver = wait_for_end;
  options.memory = MemoryGuard(800 * mebibyte, used_memory);
  std::atomic<int> spared = 0;
  options.spare_solves = [&] { return ++spared < 3 || (used = 0, true); };
  SolveStore solves(options, scenes);
  const auto solve = solves.create(scenes.use(scene), {});
  while (solve->log()->head() == 0) std::this_thread::yield();
  used = 790 * mebibyte;
  while (used > 0) std::this_thread::yield();
  EXPECT_EQ(spared, 3);
  EXPECT_FALSE(solve->ended());
}

TEST(SceneStore, SceneThatIsTooLargeForTheMemoryIsRefused) {
  used = 600 * mebibyte;
  SceneStore scenes(nullptr, {}, MemoryGuard(800 * mebibyte, used_memory));
  EXPECT_NE(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { scenes.add(squares(2), ""); }).find("scene: needs about"),
            std::string::npos);
  EXPECT_EQ(scenes.count(), 0u);
  used = 0;
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { scenes.add(squares(2), ""); }), "");
}

}  // namespace
}  // namespace alvor
