#include "server/archive/database.h"

#include "server/archive/migrations.h"
#include "server/base/failpoint.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include <cerrno>
#include <stdexcept>

namespace alvor {

namespace {

// The journal of a call of remove() holds the pages that it replaces: of each row at most one of the table, one of each of two
// indexes, and two lists of free pages (a row of 4 MB frees 1 025 pages, a list holds 1 022): 64 * 5 * 4 KB = 1.3 MB.
constexpr std::int64_t bytes_of_ballast = 4 << 20;

// A lock for as long as the database is open: two servers must not resume the same solves. What is deleted is not written over:
// that would take as much room as it had. Nothing of a change is in files elsewhere, whose disk may be full too.
constexpr const char* settings = R"(
  PRAGMA locking_mode = EXCLUSIVE;
  PRAGMA synchronous = FULL;
  PRAGMA foreign_keys = ON;
  PRAGMA secure_delete = FAST;
  PRAGMA temp_store = MEMORY;
)";

std::unique_ptr<SQLite::Database> connect(const std::filesystem::path& file) {
  auto connection = std::make_unique<SQLite::Database>(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  connection->exec(settings);
  // Else closing moves a part of an older server's write-ahead log where there is no room for all.
  sqlite3_db_config(connection->getHandle(), SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  return connection;
}

/// Returns 0 where there is no database yet. Reading it goes back from a change that a crash cut off.
int version_of(SQLite::Database& connection) {
  const int found = connection.execAndGet("PRAGMA user_version").getInt();
  if (found < 0 || found > newest_tables)
    throw std::invalid_argument("was written by a newer version of alvord: it is of version " + std::to_string(found) +
                                ", and this alvord reads versions up to " + std::to_string(newest_tables));
  return found;
}

bool has_write_ahead_log(SQLite::Database& connection) {
  return connection.execAndGet("PRAGMA journal_mode").getString() == "wal";
}

/// Moves into the database what is in the write-ahead log that older servers used. Does not begin where the disk has no room for
/// it: a part would fill the room and be of no use. It must be moved before the log is left: SQLite closes the log even where
/// that fails.
void leave_write_ahead_log(SQLite::Database& connection) {
  if (has_write_ahead_log(connection)) {
    const std::filesystem::path file = connection.getFilename();
    const auto bytes = static_cast<std::uintmax_t>(connection.execAndGet("PRAGMA page_count").getInt64() *
                                                   connection.execAndGet("PRAGMA page_size").getInt64());
    if (bytes > std::filesystem::file_size(file) + std::filesystem::space(file).available)
      throw SQLite::Exception("no room for the write-ahead log", SQLITE_FULL);
    connection.exec("PRAGMA wal_checkpoint(TRUNCATE)");
  }
  connection.exec("PRAGMA journal_mode = TRUNCATE");
}

void prepare(SQLite::Database& connection, int version_found) {
  leave_write_ahead_log(connection);
  migrate(connection, version_found);
}

/// Quotas and limits on files' sizes are full disks too. Requires: `fault` is the connection's last.
bool is_disk_full(SQLite::Database& connection, const SQLite::Exception& fault) {
  const int reason = sqlite3_system_errno(connection.getHandle());
  return fault.getErrorCode() == SQLITE_FULL ||
         (fault.getErrorCode() == SQLITE_IOERR && (reason == ENOSPC || reason == EDQUOT || reason == EFBIG));
}

std::string reason_of(const SQLite::Exception& fault) {
  switch (fault.getErrorCode()) {
    case SQLITE_READONLY: return "it cannot be written";
    case SQLITE_CANTOPEN: return "it cannot be opened";
    case SQLITE_BUSY: return "another server uses it";
    case SQLITE_NOTADB: return "alvor.db in it is no database";
    case SQLITE_CORRUPT: return "alvor.db in it is damaged";
    default: return fault.what();
  }
}

StatusError disk_full() { return {grpc::RESOURCE_EXHAUSTED, data_directory + "the disk is full"}; }

StatusError error_of(SQLite::Database& connection, const SQLite::Exception& fault) {
  if (is_disk_full(connection, fault)) return disk_full();
  const int code = fault.getErrorCode();
  const bool is_damaged = code == SQLITE_CORRUPT || code == SQLITE_NOTADB;
  return {is_damaged ? grpc::DATA_LOSS : grpc::UNAVAILABLE, data_directory + reason_of(fault)};
}

}  // namespace

Database::Database(const std::filesystem::path& directory) : ballast_(directory / "ballast", bytes_of_ballast) {
  const std::string at = "--data: '" + directory.string() + "': ";
  std::error_code failed;
  std::filesystem::create_directories(directory, failed);
  if (failed) throw std::invalid_argument(at + failed.message());
  try {
    open_somehow(directory / "alvor.db");
  } catch (const SQLite::Exception& fault) {
    throw std::invalid_argument(at + reason_of(fault));
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(at + fault.what());
  }
  is_migrated_ = fault_.empty();
  ballast_.take_up();
}

Database::~Database() = default;

void Database::open_somehow(const std::filesystem::path& file) {
  bool is_full = false;
  fault_ = open_for_writing(file, is_full);
  if (is_full) {
    ballast_.drop();
    fault_ = open_for_writing(file, is_full);
  }
  if (!fault_.empty()) open_for_reading(file, is_full);
}

/// Returns why nothing can be written; empty where something can. Throws SQLite::Exception where it cannot be read either.
std::string Database::open_for_writing(const std::filesystem::path& file, bool& is_full) {
  connection_.reset();
  connection_ = connect(file);
  try {
    version_found_ = version_of(*connection_);
    prepare(*connection_, version_found_);
    return "";
  } catch (const SQLite::Exception& fault) {
    is_full = is_disk_full(*connection_, fault);
    if (is_full) return "the disk is full";
    if (fault.getErrorCode() == SQLITE_READONLY || fault.getErrorCode() == SQLITE_CANTOPEN) return reason_of(fault);
    throw;
  }
}

/// As the last server left it. Its write-ahead log, if there is one, is then only used to remove rows, and stays.
void Database::open_for_reading(const std::filesystem::path& file, bool is_full) {
  connection_.reset();
  connection_ = connect(file);
  if (version_of(*connection_) == 0) throw std::invalid_argument(fault_);
  connection_->tryExec("PRAGMA wal_autocheckpoint = 0; BEGIN EXCLUSIVE; COMMIT");
  keeps_log_ = is_full && has_write_ahead_log(*connection_);
  fault_ += !is_full ? ": scenes and solves can be read; all else is refused until the server is started where it can write"
            : keeps_log_
                ? ": scenes and solves can be read and deleted; all else is refused until the server is started with more room"
                : ": scenes and solves can be read and deleted; all else is refused until there is room";
}

void Database::attempt(const Body& body) {
  try {
    body(*connection_);
  } catch (const SQLite::Exception& fault) {
    throw error_of(*connection_, fault);
  }
}

void Database::in_one(const Body& body) {
  attempt([&](SQLite::Database& connection) {
    SQLite::Transaction change(connection, SQLite::TransactionBehavior::IMMEDIATE);
    body(connection);
    change.commit();
  });
}

void Database::read(const Body& body) {
  Lock hold(lock_);
  attempt(body);
}

/// Brings the tables to the newest version if opening the database could not, for want of room.
void Database::complete_migration() {
  if (is_migrated_) return;
  attempt([this](SQLite::Database& connection) { migrate(connection, version_found_); });
  is_migrated_ = true;
}

/// Does not let the file grow, so that the ballast finds its room again.
void Database::in_free_pages(const Body& body) {
  const struct WithoutBallast {
    explicit WithoutBallast(const Ballast& held) : ballast(held) { ballast.drop(); }
    ~WithoutBallast() { ballast.take_up(); }
    const Ballast& ballast;
  } without_ballast(ballast_);
  complete_migration();
  const struct FixedSize {
    explicit FixedSize(SQLite::Database& open)
        : connection(open), most(connection.execAndGet("PRAGMA max_page_count").getInt64()) {
      limit(connection.execAndGet("PRAGMA page_count").getInt64());
    }
    ~FixedSize() { limit(most); }
    void limit(std::int64_t pages) const { connection.tryExec("PRAGMA max_page_count = " + std::to_string(pages)); }
    SQLite::Database& connection;
    const std::int64_t most;
  } fixed_size(*connection_);
  in_one(body);
}

void Database::write(const Body& body) {
  try {
    if (ballast_.take_up()) {
      complete_migration();
      return in_one(body);
    }
  } catch (const StatusError& refusal) {
    if (refusal.code != grpc::RESOURCE_EXHAUSTED) throw;
  }
  in_free_pages(body);
}

void Database::change(const Body& body, const std::string& step) {
  Lock hold(lock_);
  if (keeps_log_) throw disk_full();
  write([&](SQLite::Database& connection) {
    body(connection);
    failpoint(step + ".before");
  });
  failpoint(step + ".after");
}

void Database::remove(const Body& body) {
  Lock hold(lock_);
  const struct WithoutKeys {
    explicit WithoutKeys(SQLite::Database& open) : connection(open) { connection.tryExec("PRAGMA foreign_keys = OFF"); }
    ~WithoutKeys() { connection.tryExec("PRAGMA foreign_keys = ON"); }
    SQLite::Database& connection;
  } without_keys(*connection_);
  write(body);
}

void Database::restore_ballast() {
  if (!lock_.try_lock()) return;
  const Lock hold(lock_, std::adopt_lock);
  ballast_.take_up();
}

}  // namespace alvor
