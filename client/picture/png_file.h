#pragma once
// Writes PNG pictures.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace alvor {

/// A picture: rows from the top, three sRGB bytes per pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// Returns the bytes of a PNG file. Throws FileError (import/base/whole_file.h) that begins with `name`.
std::string encode_png(const Image& image, const std::string& name);

/// Writes a PNG file, which appears whole or not at all. Throws FileError.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace alvor
