#pragma once
// Pictures out.

#include <cstdint>
#include <filesystem>
#include <vector>

namespace alvor {

/// Rows from the top; three sRGB bytes per pixel.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;
};

/// The file appears whole or not at all. Throws FileError (client/whole_file.h).
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace alvor
