// Tests of a data directory on a disk that is full or cannot be written.

#include "client/rpc/client.h"
#include "server/scenes/scene_store.h"
#include "tests/server/alvord_process.h"
#include "tests/server/kept/kept_directory.h"
#include "tests/server/refusal.h"

#include <sys/mount.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

namespace alvor {
namespace {

namespace fs = std::filesystem;

/// Returns random triangles, which do not compress: half a megabyte in the database.
Scene noise(unsigned seed) {
  Scene scene;
  scene.materials.push_back({"lamp", {1, 2, 3}, {0.5, 0.5, 0.5}, false});
  std::mt19937 dice(seed);
  std::uniform_real_distribution<double> place(0, 50);
  for (std::uint32_t n = 0; n < 6000; ++n) {
    const double x = place(dice), y = place(dice), z = place(dice);
    scene.vertices.insert(scene.vertices.end(), {{x, y, z}, {x + 0.1, y, z}, {x, y + 0.1, z}});
    scene.add_face(std::array{3 * n, 3 * n + 1, 3 * n + 2}, 0);
  }
  return scene;
}

/// Mounts a small disk. Without the right to mount, the tests are skipped.
class FullDiskTest : public KeptDirectoryTest {
 protected:
  void SetUp() override {
    fs::create_directories(directory);
    if (mount("tmpfs", directory.c_str(), "tmpfs", 0, "size=16m") != 0)
      GTEST_SKIP() << "cannot mount a small disk: " << std::strerror(errno);
    is_mounted_ = true;
  }
  void TearDown() override {
    if (is_mounted_) umount2(directory.c_str(), MNT_DETACH);
  }
  /// Fills the disk to its last block.
  void fill_up() const {
    std::ofstream filler(directory / "filler", std::ios::app);
    const std::string block(4096, 'x');
    while (filler.write(block.data(), 4096).flush()) {}
    EXPECT_EQ(fs::space(directory).available, 0u);
  }
  std::uintmax_t ballast() const {
    struct stat found = {};
    return stat((directory / "ballast").c_str(), &found) == 0 ? static_cast<std::uintmax_t>(found.st_blocks) * 512 : 0;
  }
  /// Adds scenes until the disk is full. Returns the names of those that fitted.
  static std::vector<std::string> add_scenes_until_full(SceneStore& scenes) {
    std::vector<std::string> names;
    for (unsigned n = 0;; ++n) try {
        names.push_back(scenes.add(noise(n), "")->facts.name);
      } catch (const StatusError& refusal) {
        EXPECT_EQ(refusal.code, grpc::RESOURCE_EXHAUSTED) << refusal.what();
        EXPECT_STREQ(refusal.what(), "the server's data directory: the disk is full");
        return names;
      }
  }
  static std::string refusal_to_remove(SceneStore& scenes, const std::string& name) {
    return refusal_of(grpc::OK, [&] { scenes.remove(name); });
  }

 private:
  bool is_mounted_ = false;
};

TEST_F(FullDiskTest, EveryDeleteSucceedsAndGivesRoom) {
  Archive archive(directory);
  SceneStore scenes(&archive);
  const auto names = add_scenes_until_full(scenes);
  EXPECT_GE(names.size(), 10u);
  fill_up();
  for (const std::string& name : names) EXPECT_EQ(refusal_to_remove(scenes, name), "");
  EXPECT_EQ(ballast(), 4u << 20) << "for the next time";
  const auto room = add_scenes_until_full(scenes).size();
  EXPECT_GE(room + 1, names.size()) << "in the pages of those that were removed";
}

TEST_F(FullDiskTest, JournalStaysSmallHoweverLargeTheCheckpoints) {
  Archive archive(directory);
  archive.add(scene_row(1, squares(1)), squares(1));
  const Archive::SolveRow solve = solve_row(1, 1, SolveStatus::running);
  archive.add(solve, 1);
  Archive::Checkpoint checkpoint;
  checkpoint.log.assign(4, std::string(1 << 20, 'x'));
  for (int n = 0; n < 8; ++n) archive.update(solve, checkpoint);
  std::uintmax_t bytes = 0;
  for (const auto& file : fs::directory_iterator(directory))
    if (file.path().filename() != "ballast") bytes += fs::file_size(file.path());
  EXPECT_LT(bytes, 9u << 20) << "the newest, the one before it, and little more";
}

TEST_F(FullDiskTest, ServerStartsAndServesWhatIsThere) {
  std::vector<std::string> names;
  {
    Archive archive(directory);
    SceneStore scenes(&archive);
    names = add_scenes_until_full(scenes);
  }
  fill_up();
  Alvord alvord({"--listen", "127.0.0.1:0", "--data", directory.string()});
  Client client(grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials()));
  EXPECT_EQ(client.list_scenes().size(), names.size());
  EXPECT_EQ(client.read_scene(names.front()).vertices, noise(0).vertices);
  EXPECT_THROW(client.create_scene(noise(1000), ""), RpcError);
  for (const std::string& name : names) client.delete_scene(name);
  EXPECT_EQ(client.create_scene(noise(1000), "").face_count(), 6000u);
}

/// Ends the process when part of a change is already in the database's file, because the change is larger than SQLite holds in
/// memory.
[[noreturn]] void die_in_a_large_change(const fs::path& directory) {
  Database database(directory);
  database.change([](SQLite::Database& open) {
    open.exec("UPDATE scenes SET tenant = 'nobody'; INSERT INTO contents VALUES('part')");
    for (int n = 0; n < 6; ++n) open.exec("INSERT INTO content_pieces VALUES('part', 0, randomblob(1000000))");
    raise(SIGKILL);
  });
  std::_Exit(0);
}

TEST_F(FullDiskTest, ServerThatWasKilledInTheMiddleOfAWriteStarts) {
  std::string name;
  {
    Archive archive(directory);
    name = SceneStore(&archive).add(noise(0), "")->facts.name;
  }
  const auto size = fs::file_size(directory / "alvor.db");
  EXPECT_EXIT(die_in_a_large_change(directory), testing::KilledBySignal(SIGKILL), "");
  EXPECT_GT(fs::file_size(directory / "alvor.db"), size) << "a part was written";
  fill_up();
  Archive archive(directory);
  SceneStore scenes(&archive);
  EXPECT_EQ(scenes.count(), 1u);
  EXPECT_EQ(scenes.find(name)->content()->scene.vertices, noise(0).vertices);
  EXPECT_EQ(refusal_to_remove(scenes, name), "");
}

/// Ends the process like an older server: everything it wrote, slightly more than `megabytes`, is in a write-ahead log.
[[noreturn]] void die_as_an_older_server(const fs::path& directory, int megabytes) {
  SQLite::Database older((directory / "alvor.db").string(), SQLite::OPEN_READWRITE);
  older.exec(
      "PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL; PRAGMA wal_autocheckpoint = 0; DROP TABLE unkept; PRAGMA "
      "user_version = 2");
  older.exec("UPDATE scenes SET tenant = 'ali'");
  for (int n = 0; n < megabytes; ++n) older.exec("INSERT INTO content_pieces VALUES('left over', 0, randomblob(1000000))");
  raise(SIGKILL);
  std::_Exit(0);
}

TEST_F(FullDiskTest, LogOfAnOlderServerThatWasKilledIsRead) {
  for (const int megabytes : {1, 6}) {  // less and more than the ballast holds
    {
      Archive archive(directory);
      SceneStore scenes(&archive);
      for (unsigned n = 0; n < 3; ++n) scenes.add(noise(n), std::to_string(n));
    }
    EXPECT_EXIT(die_as_an_older_server(directory, megabytes), testing::KilledBySignal(SIGKILL), "");
    fill_up();
    Archive archive(directory);
    SceneStore scenes(&archive);
    const auto kept = scenes.list({}, "ali").items;
    ASSERT_EQ(kept.size(), 3u) << "as the log says";
    EXPECT_EQ(archive.take_faults().size(), megabytes == 1 ? 0u : 1u);
    for (const auto& scene : kept)
      EXPECT_EQ(refusal_of(grpc::OK, [&] { scenes.remove(scene->facts.name, "ali"); }), "") << megabytes << " MB";
    EXPECT_EQ(scenes.count(), 0u);
    fs::remove(directory / "filler");
  }
}

TEST_F(FullDiskTest, LogOfAnOlderServerIsLeftOnceThereIsRoom) {
  { SceneStore(std::make_unique<Archive>(directory).get()).add(noise(0), ""); }
  EXPECT_EXIT(die_as_an_older_server(directory, 6), testing::KilledBySignal(SIGKILL), "");
  fill_up();
  { Archive archive(directory); }
  EXPECT_TRUE(fs::exists(directory / "alvor.db-wal"));
  fs::remove(directory / "filler");
  Archive archive(directory);
  EXPECT_FALSE(fs::exists(directory / "alvor.db-wal"));
  SceneStore(&archive).add(noise(1), "");
}

TEST_F(FullDiskTest, RoomForDeletesComesBeforeNewScenes) {
  Archive archive(directory);
  SceneStore scenes(&archive);
  scenes.add(noise(0), "");
  fs::remove(directory / "ballast");
  std::ofstream(directory / "filler") << std::string(13 << 20, 'x');
  EXPECT_GT(fs::space(directory).available, 1u << 20);
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { scenes.add(noise(1), ""); }),
            "the server's data directory: the disk is full");
  fs::remove(directory / "filler");
  archive.note_alive();
  EXPECT_EQ(ballast(), 4u << 20);
}

TEST_F(FullDiskTest, WhatACrashKeptFromBeingRemovedIsRemovedAtTheStart) {
  { Archive archive(directory); }
  alter(
      "INSERT INTO content_pieces VALUES('gone', 0, zeroblob(100)); INSERT INTO checkpoint_pieces VALUES(7, 0, 0, zeroblob(9))");
  EXPECT_EQ(count("content_pieces"), 1);
  { Archive archive(directory); }
  EXPECT_EQ(count("content_pieces"), 0);
  EXPECT_EQ(count("checkpoint_pieces"), 0);
}

/// Ends the process, with 0 if stored data can be read and writing is refused with a message.
[[noreturn]] void use_as_a_stranger(const fs::path& directory, const std::string& name) {
  constexpr uid_t nobody = 65534;
  if (geteuid() == 0 && seteuid(nobody) != 0) std::_Exit(2);
  Archive archive(directory);
  SceneStore scenes(&archive);
  const auto faults = archive.take_faults();
  const bool is_said = faults == std::vector<std::string>{
                                     "the server's data directory: it cannot be written: scenes and solves can be "
                                     "read; all else is refused until the server is started where it can write"};
  const bool is_read = scenes.find(name)->content()->scene.vertices == noise(0).vertices;
  const std::string why = "the server's data directory: it cannot be written";
  const bool is_refused = refusal_of(grpc::UNAVAILABLE, [&] { scenes.add(noise(1), ""); }) == why &&
                          refusal_of(grpc::UNAVAILABLE, [&] { scenes.remove(name); }) == why;
  std::_Exit(is_said && is_read && is_refused ? 0 : 1);
}

TEST_F(KeptDirectoryTest, DirectoryThatCannotBeWrittenIsServedAndSaysSo) {
  std::string name;
  {
    Archive archive(directory);
    name = SceneStore(&archive).add(noise(0), "")->facts.name;
  }
  for (const auto& file : fs::directory_iterator(directory)) fs::permissions(file.path(), fs::perms(0444));
  fs::permissions(directory, fs::perms(0555));
  EXPECT_EXIT(use_as_a_stranger(directory, name), testing::ExitedWithCode(0), "");
  fs::permissions(directory, fs::perms(0755));
}

}  // namespace
}  // namespace alvor
