#pragma once
// Between values and columns of SQLite.

#include "server/archive/archive.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <string>
#include <string_view>

namespace alvor {

inline std::int64_t key(std::uint64_t number) { return static_cast<std::int64_t>(number); }

/// The bytes must live until the statement has run.
inline void bind_bytes(SQLite::Statement& statement, int index, const std::string& bytes) {
  statement.bindNoCopy(index, static_cast<const void*>(bytes.data()), static_cast<int>(bytes.size()));
}

/// They live until the next step of the statement.
inline std::string_view bytes_of(const SQLite::Column& column) {
  return {static_cast<const char*>(column.getBlob()), static_cast<std::size_t>(column.getBytes())};
}

/// Returns the numbers of all rows, also of those that cannot be read: where pages of the table are damaged, its index knows
/// them.
std::vector<std::int64_t> numbers_of(SQLite::Database& database, const std::string& table, const std::string& index);

}  // namespace alvor
