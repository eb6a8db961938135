#pragma once
// Bytes of any length as pieces that a store can hold: compressed, each with a version and a checksum.

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// What a piece holds at most, before compression.
inline constexpr std::size_t piece_bytes = std::size_t{4} << 20;

class PieceWriter {
 public:
  void add(std::span<const std::byte> bytes);
  /// All that was added. Nothing can be added afterwards.
  std::vector<std::string> finish();

 private:
  void compress();

  std::vector<std::byte> open_;
  std::vector<std::string> pieces_;
};

/// Appends what one piece holds. Throws BadBytes where its version is not known, or the checksum, or anything else, says that it
/// is not what was written.
void append_piece(std::string_view blob, std::vector<std::byte>& bytes);

}  // namespace alvor
