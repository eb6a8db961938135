#include "import/environment/radiance_file.h"

#include "import/base/import_error.h"

// stb_image's functions are static here: libdraco, which Assimp loads, exports functions of the same names.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_HDR
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>

namespace alvor {

namespace {

/// The bytes of a file, from which stb_image reads. At the end of a file it would go on with zeros, and never end: runs of length
/// 0. So the pixels of a file that is cut off go on with runs of length 127.
struct Source {
  const std::string& bytes;
  bool goes_on = false;
  std::size_t next = 0;
  bool is_cut_off = false;
};

const stbi_io_callbacks callbacks{
    [](void* user, char* data, int size) {
      auto& source = *static_cast<Source*>(user);
      const auto count = std::min(source.bytes.size() - source.next, static_cast<std::size_t>(std::max(0, size)));
      source.is_cut_off |= count == 0 && size > 0;
      std::memcpy(data, source.bytes.data() + source.next, count);
      source.next += count;
      if (count > 0 || !source.goes_on) return static_cast<int>(count);
      std::memset(data, 0xff, static_cast<std::size_t>(std::max(0, size)));
      return size;
    },
    [](void* user, int count) {
      auto& source = *static_cast<Source*>(user);
      source.next = std::min(source.bytes.size(), source.next + static_cast<std::size_t>(std::max(0, count)));
    },
    [](void* user) { return int{static_cast<Source*>(user)->is_cut_off}; }};

/// Returns the product of the header's exposures, by which radiance was multiplied. stb_image does not look at them.
double exposure_of(const std::string& bytes) {
  const std::string header = bytes.substr(0, bytes.find("\n\n"));
  constexpr std::string_view key = "\nEXPOSURE=";
  double exposure = 1;
  for (auto at = header.find(key); at != header.npos; at = header.find(key, at + 1))
    exposure *= std::strtod(header.c_str() + at + key.size(), nullptr);
  if (!(exposure >= 1e-30 && exposure <= 1e30)) throw ImportError("header", "its exposure is not a number within [1e-30, 1e30]");
  return exposure;
}

/// Returns the size of the shortest file with so many pixels: all runs are as long as they can be.
std::size_t least_bytes(int columns, int rows) {
  const bool is_by_runs = columns >= 8 && columns < 32768;
  const int of_row = is_by_runs ? 4 + 4 * 2 * ((columns + 126) / 127) : 4 * columns;
  return static_cast<std::size_t>(of_row) * static_cast<std::size_t>(rows);
}

}  // namespace

void read_radiance(const std::string& bytes, ImageRows& rows) {
  int width = 0, height = 0, channels = 0;
  Source header{bytes};
  if (!stbi_info_from_callbacks(&callbacks, &header, &width, &height, &channels))
    throw ImportError("header", "is not that of a Radiance picture (FORMAT=32-bit_rle_rgbe, -Y rows +X columns)");
  rows.begin(width, height);
  if (bytes.size() < least_bytes(width, height)) throw ImportError("pixels", "the file is cut off");
  const double scale = 1 / exposure_of(bytes);
  Source source{bytes, true};
  const std::unique_ptr<float, decltype(&stbi_image_free)> pixels(
      stbi_loadf_from_callbacks(&callbacks, &source, &width, &height, &channels, 3), stbi_image_free);
  if (source.is_cut_off) throw ImportError("pixels", "the file is cut off");
  if (!pixels) throw ImportError("pixels", stbi_failure_reason());
  const std::size_t samples = std::size_t{3} * static_cast<std::size_t>(width);
  for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row) {
    const std::span<float> rgb(pixels.get() + row * samples, samples);
    if (scale != 1)
      for (float& value : rgb) value = static_cast<float>(scale * double{value});
    rows.add(rgb);
  }
}

}  // namespace alvor
