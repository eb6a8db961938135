// Data directories that older versions wrote (tests/server/kept/old_data) are opened, and their solves go on or say why not.

#include "client/rpc/client.h"
#include "server/archive/record_codec.h"
#include "server/archive/rows.h"
#include "server/archive/versioned.h"
#include "server/scenes/scene_store.h"
#include "server/solves/solve_store.h"
#include "tests/server/alvord_process.h"
#include "tests/server/kept/kept_directory.h"
#include "tests/server/refusal.h"

#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <fstream>
#include <sstream>

namespace alvor {
namespace {

namespace fs = std::filesystem;

const std::string old_data = ALVOR_TEST_FILES "/server/kept/old_data/";

class MigrationTest : public KeptDirectoryTest {
 protected:
  void copy(int version) const {
    fs::remove_all(directory);
    fs::copy(old_data + "version_" + std::to_string(version), directory);
    fs::permissions(directory / "alvor.db", fs::perms(0644));
  }
  /// A server on the directory, which solves.
  struct Stores {
    explicit Stores(const fs::path& directory) : archive(directory), scenes(&archive), solves(options(), scenes) {}
    SolveStoreOptions options() {
      SolveStoreOptions made;
      made.keeping.archive = &archive;
      made.keeping.epoch = "e";
      made.limits.threads = 1;
      made.logger = std::make_shared<spdlog::logger>("test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text));
      return made;
    }
    /// By its number, 1 to 4.
    std::shared_ptr<StoredSolve> solve(std::uint64_t number) const {
      for (const auto& solve : solves.all())
        if (solve->number == number) return solve;
      throw std::out_of_range("no solve " + std::to_string(number));
    }
    SolveRecord ended(std::uint64_t number) {
      const auto last = solve(number);
      if (last->status() == SolveStatus::paused) solves.resume(last->name);
      while (!last->ended()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
      return last->describe();
    }
    bool has_logged(const std::string& words) {
      solves.shut_down();  // nobody writes any more
      return text.str().find(words) != std::string::npos;
    }
    std::ostringstream text;
    Archive archive;
    SceneStore scenes;
    SolveStore solves;
  };
  /// All rows, as the API tells them.
  static std::string told(Stores& stores) {
    std::string all;
    for (const auto& scene : stores.scenes.list({.size = 100}).items) all += encode(scene->facts).ShortDebugString() + "\n";
    for (const auto& solve : stores.solves.all()) all += encode(solve->describe()).ShortDebugString() + "\n";
    return all;
  }
  /// Leaves of the solve 1, as they were in the old bytes.
  static std::vector<LeafValue> leaves_of_the_room() {
    std::ifstream in(old_data + "room.leaves");
    std::vector<LeafValue> leaves;
    std::uint64_t id = 0;
    for (RgbF light; in >> id >> light.r >> light.g >> light.b;) leaves.push_back({PatchId::from_bits(id), light});
    return leaves;
  }
};

TEST_F(MigrationTest, ScenesAreTheSame) {
  for (const int version : {1, 2}) {
    copy(version);
    Stores stores(directory);
    const auto scenes = stores.scenes.list({.size = 100}).items;
    ASSERT_EQ(scenes.size(), 4u);
    std::map<std::string, int> names;
    for (const auto& scene : scenes) {
      ++names[scene->facts.display_name];
      EXPECT_EQ(scene->content()->scene.faces.size(), scene->facts.face_count) << "its sum is checked where it is read";
    }
    EXPECT_EQ(names, (std::map<std::string, int>{{"room.obj", 3}, {"triangles.obj", 1}})) << version;
  }
}

TEST_F(MigrationTest, FactsAreWrittenAsTheyWere) {
  for (const int version : {1, 2}) {
    copy(version);
    const SQLite::Database open((directory / "alvor.db").string(), SQLite::OPEN_READWRITE);
    const auto expect_same = [&](const std::string& table, auto&& rewritten) {
      SQLite::Statement each(open, "SELECT facts FROM " + table);
      int rows = 0;
      for (; each.executeStep(); ++rows) {
        const std::string_view facts = bytes_of(each.getColumn(0));
        const std::string again = rewritten(facts);
        EXPECT_EQ(behind_version(again, 1), behind_version(facts, 1)) << table << " of version " << version;
      }
      EXPECT_EQ(rows, 4);
    };
    expect_same("scenes", [](std::string_view facts) { return facts_of(scene_of(facts)); });
    expect_same("solves", [](std::string_view facts) { return facts_of(solve_of(facts)); });
  }
}

TEST_F(MigrationTest, SolutionsAreRead) {
  for (const int version : {1, 2}) {
    copy(version);
    Stores stores(directory);
    const auto solve = stores.solve(1);
    EXPECT_EQ(solve->status(), SolveStatus::succeeded);
    EXPECT_EQ(solve->describe().end_reason, "leaf limit reached");
    EXPECT_EQ(solve->log()->leaves(), leaves_of_the_room()) << version;
    EXPECT_EQ(solve->log()->head(), 5u);
    EXPECT_EQ(solve->log()->last_step().leaves, 58u);
    EXPECT_TRUE(solve->log()->closed());
  }
}

TEST_F(MigrationTest, LeavesOfOldSolutionsBelongToTheMeshOfToday) {
  for (const int version : {1, 2}) {
    copy(version);
    Stores stores(directory);
    for (const std::uint64_t number : {1, 3}) {
      const auto solve = stores.solve(number);
      const auto scene = stores.scenes.find(solve->name.substr(0, solve->name.find("/solves/")));
      EXPECT_EQ(solve->log()->leaves().back().patch.root_face() + 1, scene->content()->mesh.roots().size()) << version;
    }
  }
}

TEST_F(MigrationTest, SolvesGoOnWhereTheirStatesCanBeRead) {
  copy(2);
  Stores stores(directory);
  EXPECT_EQ(stores.solve(2)->status(), SolveStatus::paused);
  for (const std::uint64_t number : {2, 3, 4}) {
    const SolveRecord solve = stores.ended(number);
    EXPECT_EQ(solve.status, SolveStatus::succeeded) << number << ": " << solve.end_reason;
    EXPECT_EQ(solve.restarts, 1);
    EXPECT_EQ(solve.resumed_from_revision > 0, number != 4) << "4 had not begun";
  }
  EXPECT_TRUE(stores.has_logged("it was of version 2 and is of version 3 from now on")) << stores.text.str();
}

TEST_F(MigrationTest, SolvesWhoseStatesAreTooOldSayWhyTheyEndAndStay) {
  copy(1);
  const std::string why =
      "its checkpoint is of version 1, which an older alvord wrote; this one goes on from version 2 and later";
  for (int start = 0; start < 2; ++start) {
    Stores stores(directory);
    for (const std::uint64_t number : {2, 3}) {
      const SolveRecord solve = stores.solve(number)->describe();
      EXPECT_EQ(solve.status, SolveStatus::failed) << number;
      EXPECT_TRUE(solve.end_reason.starts_with(why)) << solve.end_reason;
      EXPECT_TRUE(solve.end_time);
      EXPECT_EQ(stores.solve(number)->log()->leaves().size(), solve.last_step->leaves) << "what it found is there";
      EXPECT_GT(solve.last_step->leaves, 0u);
      if (start == 0) continue;
      EXPECT_EQ(refusal_of(grpc::OK, [&] { stores.solves.remove(solve.name); }), "");
    }
    EXPECT_EQ(stores.ended(4).status, SolveStatus::succeeded) << "it had no state";
    EXPECT_EQ(stores.has_logged("cannot go on: " + why), start == 0) << stores.text.str();
  }
  EXPECT_EQ(count("solves"), 2);
}

TEST_F(MigrationTest, LateDatabasesOfVersion1HaveStatesThatCanBeRead) {
  copy(2);
  alter("DROP TABLE unkept; PRAGMA user_version = 1");
  Stores stores(directory);
  EXPECT_EQ(stores.solve(1)->log()->leaves(), leaves_of_the_room());
  for (const std::uint64_t number : {2, 3, 4}) EXPECT_EQ(stores.ended(number).status, SolveStatus::succeeded) << number;
}

TEST_F(MigrationTest, OpeningTwiceChangesNothing) {
  for (const int version : {1, 2}) {
    copy(version);
    std::string first;
    int pieces = 0;
    {
      Stores stores(directory);
      for (const std::uint64_t number : {2, 3, 4}) stores.ended(number);
      stores.solves.shut_down();
      first = told(stores);
    }
    pieces = count("checkpoint_pieces");
    Stores stores(directory);
    EXPECT_EQ(told(stores), first);
    EXPECT_EQ(stores.solve(1)->log()->leaves(), leaves_of_the_room());
    EXPECT_EQ(stores.archive.migration(), "");
    stores.solves.shut_down();
    EXPECT_EQ(stores.archive.solves().size(), 4u);
    EXPECT_TRUE(stores.archive.take_faults().empty());
    EXPECT_GT(pieces, 0);
  }
}

TEST_F(MigrationTest, NewerDatabaseIsRefusedByItsVersion) {
  copy(2);
  alter("PRAGMA user_version = 4");
  try {
    Archive archive(directory);
    FAIL() << "it was opened";
  } catch (const std::invalid_argument& fault) {
    EXPECT_EQ(fault.what(), "--data: '" + directory.string() +
                                "': was written by a newer version of alvord: it is of version 4, and this alvord reads "
                                "versions up to 3");
  }
}

TEST_F(MigrationTest, NewerRowsAndPiecesAreNamed) {
  copy(2);
  alter(
      "UPDATE scenes SET facts = x'0009' || facts WHERE number = 1; UPDATE checkpoint_pieces SET bytes = x'0007' || bytes WHERE "
      "solve = 2 AND kind = 0");
  Stores stores(directory);
  EXPECT_EQ(refusal_of(grpc::DATA_LOSS, [&] { stores.solve(2)->log(); }),
            "the server's data directory: a checkpoint: is of version 7, and this program reads versions up to 1");
  EXPECT_TRUE(stores.has_logged(
      "scene number 1 is not served: the server's data directory: it is of version 9, and this program reads versions up to 1"))
      << stores.text.str();
}

TEST_F(MigrationTest, SolveWhoseLogCannotBeReadFailsOnceAndSaysWhy) {
  copy(2);
  alter("UPDATE checkpoint_pieces SET bytes = x'0007' || bytes WHERE solve = 3 AND kind = 0");
  std::string first;
  {
    Stores stores(directory);
    const SolveRecord solve = stores.ended(3);
    EXPECT_EQ(solve.status, SolveStatus::failed);
    EXPECT_NE(solve.end_reason.find("is of version 7"), std::string::npos) << solve.end_reason;
    first = encode(solve).ShortDebugString();
  }
  const Stores stores(directory);
  EXPECT_EQ(encode(stores.solve(3)->describe()).ShortDebugString(), first) << "it does not begin again at each start";
}

TEST_F(MigrationTest, ServerIsStartedOnOldDirectories) {
  for (const int version : {1, 2}) {
    copy(version);
    Alvord alvord({"--listen", "127.0.0.1:0", "--data", directory.string()});
    Client client(grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials()));
    EXPECT_EQ(client.list_scenes().size(), 4u);
    const auto solves = client.list_solves("scenes/-");
    ASSERT_EQ(solves.size(), 4u);
    for (const v1::Solve& solve : solves) {
      if (solve.state() == v1::Solve::PAUSED) client.resume_solve(solve.name());
      Client::Watch watch;
      const v1::Solve ended = client.watch_solve(solve.name(), watch, [](auto&) {});
      if (solve.restarts() == 0) {  // it had ended; others may have ended since the server was started
        EXPECT_EQ(watch.mirror.leaves(), leaves_of_the_room());
      }
      EXPECT_TRUE(ended.state() == v1::Solve::SUCCEEDED || (ended.state() == v1::Solve::FAILED && version == 1))
          << ended.end_reason();
      EXPECT_EQ(watch.mirror.leaves().size(), ended.last_step().leaves());
    }
  }
}

/// Ends the process: with 0 if all that is there is read.
[[noreturn]] void read_as_a_stranger(const fs::path& directory, const std::string& name) {
  constexpr uid_t nobody = 65534;
  if (geteuid() == 0 && seteuid(nobody) != 0) std::_Exit(2);
  Archive archive(directory);
  SceneStore scenes(&archive);
  SolveStoreOptions options;
  options.keeping.archive = &archive;
  options.solver = [](auto&&...) { return SolveOutcome{}; };
  SolveStore solves(options, scenes);
  const bool is_read = scenes.count() == 4 && solves.all().size() == 4 && solves.find(name)->log()->leaves().size() == 58;
  std::_Exit(is_read && archive.migration().empty() ? 0 : 1);
}

TEST_F(MigrationTest, DirectoryThatCannotBeWrittenIsReadAsItIs) {
  copy(2);
  std::string name;
  {
    SQLite::Database open((directory / "alvor.db").string(), SQLite::OPEN_READWRITE);
    const std::string facts = open.execAndGet("SELECT facts FROM solves WHERE number = 1").getString();
    name = solve_of(facts).name;
  }
  for (const auto& file : fs::directory_iterator(directory)) fs::permissions(file.path(), fs::perms(0444));
  fs::permissions(directory, fs::perms(0555));
  EXPECT_EXIT(read_as_a_stranger(directory, name), testing::ExitedWithCode(0), "");
  fs::permissions(directory, fs::perms(0755));
}

}  // namespace
}  // namespace alvor
