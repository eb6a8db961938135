// A server's solves on several ranks.

#include "server/solves/solving_ranks.h"

#include "server/solves/solve_store.h"
#include "tests/scenes.h"
#include "tests/thread_ranks.h"

#include <gtest/gtest.h>

#include <thread>

namespace alvor {
namespace {

const SolveSpec spec{.tolerance = 0.03, .max_elements = 3000};

/// Solves two scenes after each other and returns the leaves of both.
std::vector<std::vector<LeafValue>> solve_two(Solver solver, SolveSpec of_second = spec) {
  SceneStore scenes;
  SolveStoreOptions options;
  options.solver = std::move(solver);
  SolveStore solves(options, scenes);
  std::vector<std::vector<LeafValue>> leaves;
  for (const auto& [scene, how] : {std::pair{test::coloured_room(), spec}, {test::room_with_contacts(), of_second}}) {
    const auto solve = solves.create(scenes.use(scenes.add(scene, "")->facts.name), how);
    while (!solve->ended()) std::this_thread::yield();
    EXPECT_EQ(solve->describe().status, SolveStatus::succeeded) << solve->describe().end_reason;
    leaves.push_back(solve->log()->leaves());
  }
  return leaves;
}

std::vector<std::vector<LeafValue>> solve_two_on(std::size_t size, const SolveSpec& of_second = spec) {
  std::vector<std::vector<LeafValue>> leaves;
  test::ThreadRanks::run_owning(size, [&](std::unique_ptr<Ranks> own) {
    SolvingRanks ranks(std::move(own));
    if (ranks.is_first()) leaves = solve_two(ranks.solver(), of_second);
    else ranks.follow();
  });
  return leaves;
}

TEST(SolvingRanks, AnswerOneSolveAfterTheOtherAsOneRankDoes) {
  const auto alone = solve_two(solve_in_process);
  EXPECT_GT(alone[0].size(), 100u);
  EXPECT_TRUE(solve_two_on(2) == alone);
  EXPECT_TRUE(solve_two_on(3) == alone);
}

TEST(SolvingRanks, LeaveTextbookStrategiesToTheFirst) {
  SolveSpec sorted = spec;
  sorted.strategy = Strategy::sorted;
  EXPECT_TRUE(solve_two_on(2, sorted) == solve_two(solve_in_process, sorted));
}

TEST(SolvingRanks, GoOnAfterASceneWithoutLight) {
  test::ThreadRanks::run_owning(2, [&](std::unique_ptr<Ranks> own) {
    SolvingRanks ranks(std::move(own));
    if (!ranks.is_first()) return ranks.follow();
    SceneStore scenes;
    SolveStoreOptions options;
    options.solver = ranks.solver();
    SolveStore solves(options, scenes);
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
