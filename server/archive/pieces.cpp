#include "server/archive/pieces.h"

#include "server/archive/versioned.h"
#include "solution/plain_bytes.h"

#include <zstd.h>

#include <algorithm>
#include <memory>
#include <new>

namespace alvor {

namespace {

constexpr std::uint8_t piece_version = 1;  // a zstd frame that has a checksum and says its size
constexpr int level = 1;                   // checkpoints are written often and read seldom

}  // namespace

void PieceWriter::add(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const std::size_t count = std::min(bytes.size(), piece_bytes - open_.size());
    open_.insert(open_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
    bytes = bytes.subspan(count);
    if (open_.size() == piece_bytes) compress();
  }
}

std::vector<std::string> PieceWriter::finish() {
  if (!open_.empty()) compress();
  return std::move(pieces_);
}

void PieceWriter::compress() {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  if (!context) throw std::bad_alloc();
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::string piece = version_prefix(piece_version);
  const std::size_t begin = piece.size();
  piece.resize(begin + ZSTD_compressBound(open_.size()));
  const std::size_t size = ZSTD_compress2(context.get(), piece.data() + begin, piece.size() - begin, open_.data(), open_.size());
  if (ZSTD_isError(size)) throw std::runtime_error(ZSTD_getErrorName(size));
  piece.resize(begin + size);
  piece.shrink_to_fit();
  pieces_.push_back(std::move(piece));
  open_.clear();
}

void append_piece(std::string_view blob, std::vector<std::byte>& bytes) {
  const std::string_view piece = behind_version(blob, piece_version);
  const auto size = ZSTD_getFrameContentSize(piece.data(), piece.size());
  if (size == ZSTD_CONTENTSIZE_ERROR || size == ZSTD_CONTENTSIZE_UNKNOWN || size > piece_bytes)
    throw BadBytes("a piece is not one that was written");
  const std::size_t before = bytes.size();
  bytes.resize(before + size);
  const std::size_t found = ZSTD_decompress(bytes.data() + before, size, piece.data(), piece.size());
  if (ZSTD_isError(found)) throw BadBytes(std::string("a piece is damaged: ") + ZSTD_getErrorName(found));
  if (found != size) throw BadBytes("a piece is damaged");
}

}  // namespace alvor
