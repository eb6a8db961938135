// A server's solves on several ranks.

#include "server/solves/solving_ranks.h"

#include "server/solves/solve_store.h"
#include "tests/scenes.h"
#include "tests/thread_ranks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace alvor {
namespace {

const SolveSpec spec{.tolerance = 0.03, .max_elements = 3000};

using Solutions = std::vector<std::vector<LeafValue>>;

SolveStoreOptions store_of(SolvingRanks& ranks) {
  SolveStoreOptions options;
  ranks.solve_for(options);
  return options;
}

/// Solves two scenes and returns the leaves of both.
Solutions solve_two(const SolveStoreOptions& options, const SolveSpec& of_second = spec) {
  SceneStore scenes;
  SolveStore solves(options, scenes);
  std::vector<std::shared_ptr<StoredSolve>> begun;
  for (const auto& [scene, how] : {std::pair{test::coloured_room(), spec}, {test::room_with_contacts(), of_second}})
    begun.push_back(solves.create(scenes.use(scenes.add(scene, "")->facts.name), how));
  Solutions leaves;
  for (const auto& solve : begun) {
    while (!solve->ended()) std::this_thread::yield();
    EXPECT_EQ(solve->describe().status, SolveStatus::succeeded) << solve->describe().end_reason;
    leaves.push_back(solve->log()->leaves());
  }
  return leaves;
}

/// Calls body(ranks) on the first of `size` ranks.
void run_on(std::size_t size, std::size_t gang, const std::function<void(SolvingRanks&)>& body) {
  test::ThreadRanks::run_owning(size, [&](std::unique_ptr<Ranks> own) {
    SolvingRanks ranks(std::move(own), {.gang = gang});
    if (ranks.is_first()) body(ranks);
    else ranks.follow();
  });
}

Solutions solve_two_on(std::size_t size, std::size_t gang, const SolveSpec& of_second = spec) {
  Solutions leaves;
  run_on(size, gang, [&](SolvingRanks& ranks) { leaves = solve_two(store_of(ranks), of_second); });
  return leaves;
}

TEST(SolvingRanks, AnswerAsOneRankDoesWhateverTheSizeOfGangs) {
  const Solutions alone = solve_two({});
  EXPECT_GT(alone[0].size(), 100u);
  EXPECT_TRUE(solve_two_on(2, 2) == alone);  // one after the other
  EXPECT_TRUE(solve_two_on(3, 3) == alone);
  EXPECT_TRUE(solve_two_on(2, 1) == alone);  // both at once, and the first rank shares in the work of the first only
  EXPECT_TRUE(solve_two_on(4, 2) == alone);
  EXPECT_TRUE(solve_two_on(5, 2) == alone);
  EXPECT_TRUE(solve_two_on(3, 0) == alone);
}

TEST(SolvingRanks, FormAsManyGangsAsThereAreRanksFor) {
  run_on(5, 2, [](SolvingRanks& ranks) {
    EXPECT_EQ(ranks.most_gangs(), 2u);
    const SolveOptions how;
    Solver first = ranks.solver_for(10, how);
    const Solver second = ranks.solver_for(10, how), third = ranks.solver_for(10, how);
    EXPECT_TRUE(first && second && third);  // the third has the one that is left
    EXPECT_FALSE(ranks.solver_for(10, how));
    first = {};
    EXPECT_TRUE(ranks.solver_for(10, how));
  });
}

TEST(SolvingRanks, TakeMoreRanksForLargeScenesUnlessTold) {
  run_on(4, 0, [](SolvingRanks& ranks) {
    EXPECT_EQ(ranks.most_gangs(), 4u);
    const SolveOptions how;
    Solver of_large = ranks.solver_for(12'000, how);
    const Solver of_small = ranks.solver_for(100, how);
    EXPECT_FALSE(ranks.solver_for(100, how));  // three and one
    of_large = {};
    const auto solving = [&] { return std::ranges::count(ranks.statuses(), true, &RankStatus::is_solving); };
    EXPECT_EQ(solving(), 0);
    of_large = ranks.solver_for(1'000'000, how);
    EXPECT_FALSE(ranks.solver_for(100, how));
    for (const RankStatus& status : ranks.statuses()) EXPECT_GT(status.resident_bytes, 0u);
  });
}

TEST(SolvingRanks, EndASolveWhenTheMemoryOfOneIsShort) {
  test::ThreadRanks::run_owning(2, [](std::unique_ptr<Ranks> own) {
    const MemoryGuard memory = own->is_first() ? MemoryGuard() : MemoryGuard(1000, [] { return std::uint64_t{1000}; });
    SolvingRanks ranks(std::move(own), {.gang = 2, .memory = memory});
    if (!ranks.is_first()) return ranks.follow();
    SceneStore scenes;
    SolveStore solves(store_of(ranks), scenes);
    const SolveSpec endless{.tolerance = 1e-4, .max_elements = 1'000'000};
    const auto solve = solves.create(scenes.use(scenes.add(test::coloured_room(), "")->facts.name), endless);
    while (!solve->ended()) std::this_thread::yield();
    EXPECT_EQ(solve->describe().end_reason, text(StopReason::memory));
  });
}

/// Solves a room, edits its materials and moves and copies objects, and returns the leaves after each step.
Solutions solve_and_edit(const SolveStoreOptions& options) {
  SceneStore scenes;
  SolveStore solves(options, scenes);
  const auto solve = solves.create(scenes.use(scenes.add(test::room_of_objects(), "")->facts.name), spec);
  Solutions leaves;
  const auto end = [&](std::uint64_t edits) {
    while (!solve->ended()) std::this_thread::yield();
    EXPECT_EQ(solve->describe().status, SolveStatus::succeeded) << solve->describe().end_reason;
    EXPECT_EQ(solve->log()->last_step().edits, edits);
    leaves.push_back(solve->log()->leaves());
  };
  end(0);
  const std::vector<std::vector<SceneEdit>> steps{
      {MaterialEdit{.name = "m0", .reflectance = Rgb{0.2, 0.3, 0.4}}},
      {ObjectEdit{.name = "box", .move = Vec3{0.3, 0.2, 1.5}}, ObjectEdit{.name = "lamp", .dim = 0.5}},
      {ObjectCopy{"second lamp", "lamp"}, ObjectEdit{.name = "second lamp", .move = Vec3{-1, -0.2, -1}}}};
  for (std::uint64_t n = 0; n < steps.size(); ++n) {
    EXPECT_EQ(solves.edit(solve->name, {.step = {EditStep::Kind::edit, steps[n]}}), n + 1);
    end(n + 1);
  }
  return leaves;
}

TEST(SolvingRanks, FindAfterEditsWhatOneRankFinds) {
  const Solutions alone = solve_and_edit({});
  for (const std::size_t size : {2, 3}) {
    Solutions together;
    run_on(size, size, [&](SolvingRanks& ranks) { together = solve_and_edit(store_of(ranks)); });
    EXPECT_TRUE(together == alone) << size;
  }
}

TEST(SolvingRanks, LeaveTextbookStrategiesToTheFirst) {
  SolveSpec sorted = spec;
  sorted.strategy = Strategy::sorted;
  EXPECT_TRUE(solve_two_on(2, 2, sorted) == solve_two({}, sorted));
}

TEST(SolvingRanks, GoOnAfterASceneWithoutLight) {
  run_on(2, 2, [](SolvingRanks& ranks) {
    SceneStore scenes;
    SolveStore solves(store_of(ranks), scenes);
    Scene dark = test::coloured_room();
    for (Material& material : dark.materials) material.emission = {};
    for (const Scene& scene : {dark, test::coloured_room()}) {
      const auto solve = solves.create(scenes.use(scenes.add(scene, "")->facts.name), spec);
      while (!solve->ended()) std::this_thread::yield();
      EXPECT_EQ(solve->describe().status, SolveStatus::succeeded);
    }
  });
}

}  // namespace
}  // namespace alvor
