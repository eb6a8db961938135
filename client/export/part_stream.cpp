#include "client/export/part_stream.h"

#include "client/export/solution_file.h"

#include <google/protobuf/io/coded_stream.h>
#include <zstd.h>

#include <algorithm>
#include <limits>

namespace alvor {

namespace {

constexpr std::uint32_t most_raw_bytes = 16 << 20;  // of one message
constexpr std::uint64_t unpacked_of_file = 50, unpacked_at_least = 64 << 20;
constexpr int compression_level = 15;

}  // namespace

void append_part(std::string& bytes, const v1::SolutionPart& part) {
  std::uint8_t length[10];
  const std::uint8_t* const end = google::protobuf::io::CodedOutputStream::WriteVarint64ToArray(part.ByteSizeLong(), length);
  bytes.append(reinterpret_cast<const char*>(length), static_cast<std::size_t>(end - length));
  part.AppendToString(&bytes);
}

v1::CompressedMessage compressed(const google::protobuf::Message& message) {
  const std::string raw = message.SerializeAsString();
  std::string packed(ZSTD_compressBound(raw.size()), '\0');
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), compression_level);
  if (ZSTD_isError(size) || raw.size() > most_raw_bytes) throw SolutionFileError("a part is too large to be written");
  packed.resize(size);
  v1::CompressedMessage result;
  result.set_raw_size(static_cast<std::uint32_t>(raw.size()));
  result.set_zstd(std::move(packed));
  return result;
}

PartReader::PartReader(std::string_view bytes)
    : rest_(bytes), unpacked_left_(unpacked_at_least + unpacked_of_file * bytes.size()) {
  if (!bytes.starts_with(compact_magic)) throw SolutionFileError("header: not a compact solution file");
  rest_.remove_prefix(compact_magic.size());
}

std::optional<v1::SolutionPart> PartReader::next() {
  if (rest_.empty()) return std::nullopt;
  google::protobuf::io::CodedInputStream input(reinterpret_cast<const std::uint8_t*>(rest_.data()),
                                               static_cast<int>(std::min<std::size_t>(rest_.size(), 10)));
  std::uint64_t length = 0;
  if (!input.ReadVarint64(&length)) fail("its length is missing");
  rest_.remove_prefix(static_cast<std::size_t>(input.CurrentPosition()));
  if (length > rest_.size() || length > std::numeric_limits<int>::max()) fail("longer than the file");
  v1::SolutionPart part;
  if (!part.ParseFromArray(rest_.data(), static_cast<int>(length))) fail("not a message");
  rest_.remove_prefix(static_cast<std::size_t>(length));
  ++part_;
  return part;
}

void PartReader::unpack(const v1::CompressedMessage& packed, google::protobuf::Message& message) {
  if (packed.raw_size() > most_raw_bytes || packed.raw_size() > unpacked_left_) fail("it would take too much memory");
  unpacked_left_ -= packed.raw_size();
  std::string raw(packed.raw_size(), '\0');
  const std::size_t size = ZSTD_decompress(raw.data(), raw.size(), packed.zstd().data(), packed.zstd().size());
  if (size != raw.size()) fail("is not " + std::to_string(raw.size()) + " bytes compressed");
  if (!message.ParseFromString(raw)) fail("not a message");
}

void PartReader::fail(const std::string& reason) const {
  throw SolutionFileError("part " + std::to_string(part_) + ": " + reason);
}

}  // namespace alvor
