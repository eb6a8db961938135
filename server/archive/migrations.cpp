#include "server/archive/migrations.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <cassert>
#include <string>

namespace alvor {

namespace {

constexpr const char* first_tables = R"(
  CREATE TABLE contents(sha256 TEXT PRIMARY KEY);
  CREATE TABLE content_pieces(sha256 TEXT NOT NULL REFERENCES contents ON DELETE CASCADE, n INTEGER NOT NULL, bytes BLOB NOT NULL);
  CREATE INDEX content_pieces_of ON content_pieces(sha256, n);
  CREATE TABLE scenes(number INTEGER PRIMARY KEY, tenant TEXT NOT NULL, request_id TEXT NOT NULL,
    sha256 TEXT NOT NULL REFERENCES contents, facts BLOB NOT NULL);
  CREATE INDEX scenes_of ON scenes(sha256);
  CREATE TABLE solves(number INTEGER PRIMARY KEY, scene INTEGER NOT NULL REFERENCES scenes, tenant TEXT NOT NULL,
    request_id TEXT NOT NULL, facts BLOB NOT NULL);
  CREATE INDEX solves_of ON solves(scene);
  CREATE TABLE lineage(solve INTEGER NOT NULL REFERENCES solves ON DELETE CASCADE, epoch TEXT NOT NULL, revision INTEGER NOT NULL,
    PRIMARY KEY(solve, epoch));
  CREATE TABLE checkpoint_pieces(solve INTEGER NOT NULL REFERENCES solves ON DELETE CASCADE, kind INTEGER NOT NULL,
    n INTEGER NOT NULL, bytes BLOB NOT NULL);
  CREATE INDEX checkpoint_pieces_of ON checkpoint_pieces(solve, kind, n);
)";

// Version 2 changed the layout of saved logs, not the tables. SolutionLog converts old logs when it reads them: to write all of
// them anew would take as much room again, and time at the start.
constexpr const char* no_change_of_tables = "";

// With version 3 blobs begin with a version (versioned.h); those that are there stay as they are. `unkept` has the moment of a
// run, in microseconds, since which the work of a running solve is in no checkpoint; late databases of version 2 have it.
constexpr const char* work_in_no_checkpoint = R"(
  CREATE TABLE IF NOT EXISTS unkept(solve INTEGER PRIMARY KEY REFERENCES solves ON DELETE CASCADE, run TEXT NOT NULL,
    age INTEGER NOT NULL);
)";

// From each version, beginning with 0, to the next.
constexpr std::array<const char*, newest_tables> steps{first_tables, no_change_of_tables, work_in_no_checkpoint};

}  // namespace

void migrate(SQLite::Database& connection, int found) {
  assert(0 <= found && found <= newest_tables);
  SQLite::Transaction change(connection, SQLite::TransactionBehavior::EXCLUSIVE);
  for (int version = found; version < newest_tables; ++version) connection.exec(steps[static_cast<std::size_t>(version)]);
  connection.exec("PRAGMA user_version = " + std::to_string(newest_tables));
  change.commit();
}

}  // namespace alvor
