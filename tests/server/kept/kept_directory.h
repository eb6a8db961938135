#pragma once
// A data directory for a test, and direct access to its database.

#include "server/archive/archive.h"
#include "server/archive/content.h"
#include "tests/server/sample_scenes.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace alvor {

class KeptDirectoryTest : public testing::Test {
 protected:
  KeptDirectoryTest() { std::filesystem::remove_all(directory); }
  ~KeptDirectoryTest() override { std::filesystem::remove_all(directory); }

  /// Runs `sql` on the database. Requires: no archive has it open.
  void alter(const std::string& sql) const {
    SQLite::Database((directory / "alvor.db").string(), SQLite::OPEN_READWRITE).exec(sql);
  }
  int count(const std::string& table) const {
    return SQLite::Database((directory / "alvor.db").string(), SQLite::OPEN_READWRITE)
        .execAndGet("SELECT count(*) FROM " + table)
        .getInt();
  }
  static Archive::SceneRow scene_row(std::uint64_t number, const Scene& content) {
    Archive::SceneRow row{number, "", "", {}};
    row.facts.name = "scenes/s" + std::to_string(number);
    row.facts.content_sha256 = measure(content).sha256;
    return row;
  }
  static Archive::SolveRow solve_row(std::uint64_t number, std::uint64_t scene, SolveStatus status) {
    Archive::SolveRow row{number, "", "", {}, {}};
    row.facts.name = "scenes/s" + std::to_string(scene) + "/solves/s" + std::to_string(number);
    row.facts.status = status;
    return row;
  }

  const std::filesystem::path directory =
      std::filesystem::temp_directory_path() /
      ("alvor_" + std::to_string(getpid()) + "_" + testing::UnitTest::GetInstance()->current_test_info()->name());
};

}  // namespace alvor
