#include "import/apart/records.h"

#include "import/base/bytes.h"

#include <algorithm>
#include <cassert>

namespace alvor {

namespace {

constexpr std::size_t head_bytes = 5;
constexpr std::size_t piece_bytes = std::size_t{1} << 24;

}  // namespace

bool RecordStream::write_all(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::size_t count = write_some(bytes.data(), bytes.size());
    if (count == 0) return false;
    bytes.remove_prefix(count);
  }
  return true;
}

/// Fills `bytes` piece by piece, so that a length alone takes no memory.
bool RecordStream::read_all(std::string& bytes, std::size_t size) {
  bytes.clear();
  while (bytes.size() < size) {
    const std::size_t filled = bytes.size();
    bytes.resize(std::min(size, filled + piece_bytes));
    const std::size_t count = read_some(bytes.data() + filled, bytes.size() - filled);
    if (count == 0) return false;
    bytes.resize(filled + count);
  }
  return true;
}

bool RecordStream::write(RecordKind kind, std::string_view bytes) {
  assert(bytes.size() <= largest_record);
  std::string head;
  append_value(head, static_cast<std::uint8_t>(kind));
  append_value(head, static_cast<std::uint32_t>(bytes.size()));
  return write_all(head) && write_all(bytes);
}

bool RecordStream::write_file(std::string_view name, std::string_view bytes) {
  if (!write(RecordKind::file, name)) return false;
  for (; !bytes.empty(); bytes.remove_prefix(std::min(bytes.size(), piece_bytes)))
    if (!write(RecordKind::piece, bytes.substr(0, piece_bytes))) return false;
  return true;
}

std::optional<Record> RecordStream::read() {
  std::string head;
  if (!read_all(head, head_bytes)) return std::nullopt;
  const auto kind = value_at<std::uint8_t>(head, 0);
  const std::size_t size = value_at<std::uint32_t>(head, 1);
  if (kind > static_cast<std::uint8_t>(RecordKind::error) || size > largest_record) return std::nullopt;
  Record record{static_cast<RecordKind>(kind), {}};
  if (!read_all(record.bytes, size)) return std::nullopt;
  return record;
}

}  // namespace alvor
