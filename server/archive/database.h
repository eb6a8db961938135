#pragma once
// The SQLite database of a data directory, how it is opened, and what is done when the disk is full.

#include "server/archive/ballast.h"
#include "server/base/mutex.h"
#include "server/base/status_error.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

namespace SQLite {
class Database;
}

namespace alvor {

/// With this begins each message about it.
inline const std::string data_directory = "the server's data directory: ";
/// Returns the error DATA_LOSS, for data of the archive that is not what was written. `what` says which data.
inline StatusError data_loss(const std::string& what) { return {grpc::DATA_LOSS, data_directory + what}; }

/// Thread-safe. Each change is one transaction: when a call returns, all of it is on the disk; when it throws, nothing is. Throws
/// StatusError: RESOURCE_EXHAUSTED when the disk is full, UNAVAILABLE when it cannot be written or read, DATA_LOSS when the
/// database is damaged.
///
/// The journal is a rollback journal, which holds only the pages that a change replaces: new rows need no room there, so it is
/// small however large the change is, and going back after a crash needs no room at all. On a full disk it is written in the
/// room of the ballast, and changes must fit into pages of the database that are free; so removing rows always succeeds, and
/// gives room for others.
class Database {
 public:
  using Body = std::function<void(SQLite::Database&)>;

  /// Opens or makes `directory`/alvor.db and keeps other servers out of it. Brings tables of an older version to the newest, at
  /// the first change where there is no room before. Throws std::invalid_argument saying why it cannot, also where the database
  /// is of a newer version.
  explicit Database(const std::filesystem::path& directory);
  ~Database();

  /// Returns why nothing could be written when it was opened, not even in the ballast's room, and what can be done all the same;
  /// empty where something could.
  const std::string& fault() const { return fault_; }
  /// Returns the version that its tables had when it was opened; 0 where it had none.
  int version_found() const { return version_found_; }

  void read(const Body& body);
  /// `step`, where there is one, is a failpoint. `body` is called again where it finds the disk full.
  void change(const Body& body, const std::string& step = "");
  /// For changes that remove rows, at most `rows_at_a_time` large ones. Foreign keys are not looked at: rows that refer to
  /// removed ones are the caller's.
  void remove(const Body& body);
  static constexpr int rows_at_a_time = 64;

  /// Takes up the ballast where there was no room for it before. Returns at once while the database is in use.
  void restore_ballast();

 private:
  void open_somehow(const std::filesystem::path& file) ALVOR_REQUIRES(lock_);
  std::string open_for_writing(const std::filesystem::path& file, bool& is_full) ALVOR_REQUIRES(lock_);
  void open_for_reading(const std::filesystem::path& file, bool is_full) ALVOR_REQUIRES(lock_);
  void attempt(const Body& body) ALVOR_REQUIRES(lock_);
  void in_one(const Body& body) ALVOR_REQUIRES(lock_);
  void complete_migration() ALVOR_REQUIRES(lock_);
  void in_free_pages(const Body& body) ALVOR_REQUIRES(lock_);
  void write(const Body& body) ALVOR_REQUIRES(lock_);

  const Ballast ballast_;
  Mutex lock_;
  std::unique_ptr<SQLite::Database> connection_ ALVOR_GUARDED_BY(lock_);
  std::string fault_;
  int version_found_ = 0;                             ///< of its tables, when it was opened
  bool is_migrated_ ALVOR_GUARDED_BY(lock_) = false;  ///< its tables are of the newest version
  bool keeps_log_ ALVOR_GUARDED_BY(lock_) = false;    ///< of an older server: there is no room to leave it
};

}  // namespace alvor
