#pragma once
// Between values and columns of SQLite.

#include "server/archive/archive.h"
#include "server/archive/versioned.h"

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

/// The messages of the API, as `facts` of scenes and solves.
inline constexpr std::uint8_t facts_version = 1;

template <class Message>
std::string facts_of(const Message& message) {
  std::string facts = version_prefix(facts_version);
  message.AppendToString(&facts);
  return facts;
}

/// Throws DATA_LOSS.
template <class Message>
Message parsed(const SQLite::Column& column) {
  Message message;
  std::string_view bytes;
  try {
    bytes = behind_version(bytes_of(column), facts_version);
  } catch (const BadBytes& fault) {
    throw data_loss(std::string("it ") + fault.what());
  }
  if (!message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) throw data_loss("it is damaged");
  return message;
}

/// Returns the numbers of all rows, also of those that cannot be read: where pages of the table are damaged, its index knows
/// them.
std::vector<std::int64_t> numbers_of(SQLite::Database& database, const std::string& table, const std::string& index);

}  // namespace alvor
