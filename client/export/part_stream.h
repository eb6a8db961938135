#pragma once
// The parts of a compact solution file as a stream of messages.

#include "alvor/v1/solution_file.pb.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace alvor {

/// The bytes with which every compact solution file begins.
inline constexpr std::string_view compact_magic =
    "\x89"
    "ALVOR\r\n";

// Versions of the file: one without leaves that are slabs, and the newest.
inline constexpr std::uint32_t without_slabs = 1, newest_version = 2;
/// A file holds at most leaves_at_least + leaves_per_byte * its bytes leaves, so that a small one cannot ask for much memory.
inline constexpr std::uint64_t leaves_at_least = 1 << 20, leaves_per_byte = 8;

/// Appends a part, after its length.
void append_part(std::string& bytes, const v1::SolutionPart& part);

/// Returns a message as bytes that zstd has compressed.
v1::CompressedMessage compressed(const google::protobuf::Message& message);

/// Reads the parts of a file one after the other. Throws SolutionFileError that names the part.
class PartReader {
 public:
  /// Throws if the bytes are no compact solution file.
  explicit PartReader(std::string_view bytes);
  /// Returns the next part; nothing at the end.
  std::optional<v1::SolutionPart> next();
  /// Sets `message` to what a part of this file holds. All of them together may take 64 MB and fifty times the file.
  void unpack(const v1::CompressedMessage& packed, google::protobuf::Message& message);
  [[noreturn]] void fail(const std::string& reason) const;

 private:
  std::string_view rest_;
  std::uint64_t unpacked_left_;
  std::size_t part_ = 0;
};

}  // namespace alvor
