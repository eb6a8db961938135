// Tests how much work of a running solve is counted as lost in a crash, by the clock of the run that crashed.

#include "server/solves/stored_solve.h"
#include "tests/server/kept/kept_directory.h"

#include <fstream>
#include <optional>

namespace alvor {
namespace {

using namespace std::chrono_literals;

class WorkLostTest : public KeptDirectoryTest {
 protected:
  RunClock clock() {
    return [this] { return now; };
  }
  /// A run of the server, from construction to destruction.
  struct Run {
    explicit Run(WorkLostTest& test) : archive(test.directory, test.clock()), now(test.now) {}
    void at(std::chrono::seconds age) { now = begun + age; }
    Archive archive;
    std::chrono::microseconds& now;
    const std::chrono::microseconds begun = now;
  };
  /// Adds the scene 1 and a solve of it.
  Archive::SolveRow add_solve(Archive& archive) {
    archive.add(scene_row(1, squares(1)), squares(1));
    Archive::SolveRow row = solve_row(1, 1, SolveStatus::queued);
    archive.add(row, 1);
    row.facts.status = SolveStatus::running;
    return row;
  }
  std::optional<std::chrono::microseconds> lost() {
    now += 3h;  // no run existed
    return Archive(directory, clock()).solves().at(0).work_lost;
  }
  /// Time of the clock, whose zero has no meaning.
  std::chrono::microseconds now = 5h;
};

TEST_F(WorkLostTest, IsTheTimeFromTheCheckpointToTheLastSignOfLife) {
  {
    Run run(*this);
    Archive::SolveRow row = add_solve(run.archive);
    run.at(2s);
    run.archive.update(row);
    run.at(20s);
    run.archive.update(row, Archive::Checkpoint{});
    run.at(23s);
    run.archive.note_alive();
  }
  EXPECT_EQ(lost(), 3s);
}

TEST_F(WorkLostTest, BeginsWhenTheSolveDoesWhereThereIsNoCheckpoint) {
  {
    Run run(*this);
    Archive::SolveRow row = add_solve(run.archive);
    run.at(1000s);  // the solve waited
    run.archive.update(row);
    run.at(1003s);
    run.archive.update(row);
    run.at(1004s);
    run.archive.note_alive();
  }
  EXPECT_EQ(lost(), 4s);
}

TEST_F(WorkLostTest, DoesNotCountAPause) {
  {
    Run run(*this);
    Archive::SolveRow row = add_solve(run.archive);
    run.archive.update(row);
    run.at(10s);
    row.facts.status = SolveStatus::paused;
    run.archive.update(row);
    run.at(100s);
    row.facts.status = SolveStatus::running;
    run.archive.update(row);
    run.at(106s);
    run.archive.note_alive();
  }
  EXPECT_EQ(lost(), 6s);
}

TEST_F(WorkLostTest, IsNeverNegative) {
  {
    Run run(*this);
    Archive::SolveRow row = add_solve(run.archive);
    run.at(20s);
    run.archive.update(row, Archive::Checkpoint{});
  }
  EXPECT_EQ(lost(), 0s);
}

TEST_F(WorkLostTest, OfARunBeforeTheLastIsNotTold) {
  {
    Run run(*this);
    run.archive.update(add_solve(run.archive));
    run.at(9s);
    run.archive.note_alive();
  }
  { Run idle(*this); }
  EXPECT_EQ(lost(), std::nullopt);
}

TEST_F(WorkLostTest, IsNotToldWhereTheSignOfLifeIsDamagedOrMissing) {
  {
    Run run(*this);
    run.archive.update(add_solve(run.archive));
  }
  std::ofstream(directory / "alive") << "1";
  EXPECT_EQ(lost(), std::nullopt);
  std::filesystem::remove(directory / "alive");
  EXPECT_EQ(lost(), std::nullopt);
}

TEST_F(WorkLostTest, HasNothingToDoWithTheTimeOfDay) {
  {
    Run run(*this);
    Archive::SolveRow row = add_solve(run.archive);
    row.facts.create_time = SolveRecord::Time(0s);
    row.facts.checkpoint_time = SolveRecord::Time(1s);  // the wall clock was set ahead ten years
    run.archive.update(row, Archive::Checkpoint{});
    run.at(7s);
    run.archive.note_alive();
  }
  Archive archive(directory, clock());
  SceneStore scenes(&archive);
  const StoredSolve solve(archive.solves().at(0), scenes.use("scenes/s1").scene, {}, {}, {.archive = &archive});
  EXPECT_EQ(solve.describe().work_lost, 7s);
}

}  // namespace
}  // namespace alvor
