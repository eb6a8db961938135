#include "server/archive/rows.h"

#include <sqlite3.h>

#include <algorithm>

namespace alvor {

namespace {

std::vector<std::int64_t> sorted_numbers(SQLite::Database& database, const std::string& source) {
  std::vector<std::int64_t> numbers;
  SQLite::Statement each(database, "SELECT number FROM " + source);
  while (each.executeStep()) numbers.push_back(each.getColumn(0).getInt64());
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace

std::vector<std::int64_t> numbers_of(SQLite::Database& database, const std::string& table, const std::string& index) {
  try {
    return sorted_numbers(database, table + " NOT INDEXED");
  } catch (const SQLite::Exception& fault) {
    if (fault.getErrorCode() != SQLITE_CORRUPT) throw;
  }
  return sorted_numbers(database, table + " INDEXED BY " + index);
}

}  // namespace alvor
