#pragma once
// Writes and reads PNG pictures.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace alvor {

/// A picture: rows from the top, three sRGB bytes per pixel, and if it has any opacity a fourth byte for it.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
  bool has_opacity = false;

  std::size_t bytes_a_pixel() const { return has_opacity ? 4 : 3; }
};

/// Returns the bytes of a PNG file. Throws FileError (import/base/whole_file.h) that begins with `name`.
std::string encode_png(const Image& image, const std::string& name);

/// Returns the picture in the bytes of a PNG file; with opacity if the file has any. Throws FileError if it is none, or larger
/// than `most_columns` x `most_rows`.
Image decode_png(std::string_view bytes, std::uint32_t most_columns, std::uint32_t most_rows);

/// Writes a PNG file, which appears whole or not at all. Throws FileError.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace alvor
