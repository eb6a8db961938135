// The log of a kept solve leaves memory when nobody holds it, and is loaded again when it is asked for.

#include "server/solves/solve_store.h"
#include "tests/scenes.h"
#include "tests/server/kept/kept_directory.h"

#include <thread>

namespace alvor {
namespace {

class KeptLogTest : public KeptDirectoryTest {
 protected:
  static SolveStoreOptions options_for(Archive& archive) {
    SolveStoreOptions options;
    options.keeping.archive = &archive;
    options.keeping.epoch = "e";
    return options;
  }
  Archive archive{directory};
  SceneStore scenes{&archive};
  SolveStore solves{options_for(archive), scenes};
  const std::string scene = scenes.add(test::room_with_contacts(), "")->facts.name;
};

TEST_F(KeptLogTest, OfASolveThatIsCancelledWhilePausedCanBeDropped) {
  const SolveSpec slow{.tolerance = 0.02, .max_elements = 4000, .step_pause_s = 0.05};
  const auto solve = solves.create(scenes.use(scene), slow);
  while (solve->log()->head() == 0) std::this_thread::yield();
  solves.pause(solve->name);
  while (solve->status() != SolveStatus::paused) std::this_thread::yield();
  solves.cancel(solve->name);
  std::weak_ptr<SolutionLog> in_memory = solve->log();
  const auto leaves = solve->log()->leaves();
  while (!in_memory.expired()) solve->drop_log();
  EXPECT_EQ(solve->log()->leaves(), leaves);
}

TEST_F(KeptLogTest, OfAnEndedSolveIsInMemoryWhileSomebodyHoldsIt) {
  const auto solve = solves.create(scenes.use(scene), {.max_elements = 300});
  while (!solve->ended()) std::this_thread::yield();
  std::weak_ptr<SolutionLog> in_memory;
  std::vector<LeafValue> leaves;
  {
    const auto log = solve->log();
    in_memory = log;
    leaves = log->leaves();
    solve->drop_log();
    EXPECT_EQ(solve->log(), log) << "somebody holds it";
  }
  // The solver's thread may be dropping the log at the same time.
  while (!in_memory.expired()) solve->drop_log();
  EXPECT_EQ(solve->log()->leaves(), leaves);
  EXPECT_TRUE(solve->log()->closed());
}

}  // namespace
}  // namespace alvor
