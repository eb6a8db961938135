#pragma once
// The tables of the database, and how those of an older version become those of the next.

namespace SQLite {
class Database;
}

namespace alvor {

/// The version of the tables that this program makes; SQLite's `user_version` tells that of a database, 0 where it is empty.
inline constexpr int newest_tables = 3;

/// Brings the tables from version `found` to the newest in one transaction, and writes the version down, also where it is the
/// newest already: this fails where the database cannot be written. Requires: 0 <= found <= newest_tables. Throws
/// SQLite::Exception; then nothing was changed.
void migrate(SQLite::Database& connection, int found);

}  // namespace alvor
