#pragma once
// Images of textures as bytes of files, for tests.

#include <webp/encode.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace alvor::test {

using Texel = std::array<std::uint8_t, 4>;  // red, green, blue, alpha
using Texels = std::vector<Texel>;          // row by row from the top

/// Returns an uncompressed TGA image, its top row first.
inline std::string tga(int columns, const Texels& texels, bool has_alpha = true) {
  const auto byte = [](std::size_t value) { return static_cast<char>(static_cast<unsigned char>(value)); };
  const std::size_t rows = texels.size() / static_cast<std::size_t>(columns);
  std::string bytes(12, '\0');
  bytes[2] = 2;  // colours as they are
  for (const std::size_t size : {static_cast<std::size_t>(columns), rows}) bytes += {byte(size % 256), byte(size / 256)};
  bytes += {byte(has_alpha ? 32 : 24), byte(has_alpha ? 0x28 : 0x20)};
  for (const Texel& texel : texels) {
    bytes += {byte(texel[2]), byte(texel[1]), byte(texel[0])};
    if (has_alpha) bytes += byte(texel[3]);
  }
  return bytes;
}

struct WebpKind {
  bool is_lossless = true, has_alpha = true;
};

/// Returns a WebP image. Lossless, it keeps the colours of all texels, also of those that cannot be seen.
inline std::string webp(int columns, const Texels& texels, const WebpKind& kind = {}) {
  WebPConfig config;
  WebPPicture picture;
  WebPMemoryWriter writer;
  bool is_written = WebPConfigInit(&config) && WebPPictureInit(&picture);
  WebPMemoryWriterInit(&writer);
  config.lossless = config.exact = kind.is_lossless;
  picture.use_argb = 1;
  picture.width = columns;
  picture.height = static_cast<int>(texels.size()) / columns;
  picture.writer = WebPMemoryWrite;
  picture.custom_ptr = &writer;
  const std::uint8_t* const first = texels.front().data();
  is_written = is_written &&
               (kind.has_alpha ? WebPPictureImportRGBA(&picture, first, 4 * columns)
                               : WebPPictureImportRGBX(&picture, first, 4 * columns)) &&
               WebPEncode(&config, &picture);
  const std::string bytes(reinterpret_cast<const char*>(writer.mem), is_written ? writer.size : 0);
  WebPMemoryWriterClear(&writer);
  WebPPictureFree(&picture);
  return bytes;
}

/// Returns a number as bytes, the lowest first.
inline std::string little_endian(std::size_t number, int bytes) {
  std::string all;
  for (int i = 0; i < bytes; ++i) all += static_cast<char>(static_cast<unsigned char>(number >> (8 * i)));
  return all;
}

/// Returns a chunk of a RIFF file, padded to an even length.
inline std::string riff_chunk(const std::string& name, const std::string& bytes) {
  return name + little_endian(bytes.size(), 4) + bytes + std::string(bytes.size() % 2, '\0');
}
inline std::string webp_of_chunks(const std::string& chunks) { return riff_chunk("RIFF", "WEBP" + chunks); }

/// Returns the chunk of a lossless WebP image whose pixels are all 60, 100, 20. It has 20 bytes, because pixels take no bits.
inline std::string flat_webp_chunk(std::size_t columns, std::size_t rows) {
  std::vector<bool> bits;  // the lowest of a byte first
  const auto put = [&](std::size_t value, int count) {
    for (int i = 0; i < count; ++i) bits.push_back((value >> i) % 2 != 0);
  };
  put(0x2f, 8), put(columns - 1, 14), put(rows - 1, 14);
  put(0, 1 + 3);  // no alpha; version
  put(0, 3);      // no transforms, no cache of colours, one group of codes
  // Codes of one symbol each, of 8 bits: green, red, blue and alpha.
  for (const std::size_t symbol : {100, 60, 20, 130}) put(0b101, 3), put(symbol, 8);
  put(0b0001, 4);  // distances: one symbol, of one bit
  std::string bytes((bits.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < bits.size(); ++i)
    if (bits[i]) bytes[i / 8] = static_cast<char>(bytes[i / 8] | 1 << (i % 8));
  return riff_chunk("VP8L", bytes);
}
inline std::string webp_of_one_colour(std::size_t columns, std::size_t rows) {
  return webp_of_chunks(flat_webp_chunk(columns, rows));
}

}  // namespace alvor::test
