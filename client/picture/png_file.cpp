#include "client/picture/png_file.h"

#include "import/base/whole_file.h"

#include <png.h>

#include <cassert>
#include <memory>
#include <string>

namespace alvor {
namespace {

/// Wraps libpng's simplified interface, which needs no setjmp. Frees libpng's memory at the end of the scope.
struct PngWriter {
  png_image header{};
  explicit PngWriter(const Image& image) {
    header.version = PNG_IMAGE_VERSION;
    header.width = static_cast<png_uint_32>(image.width);
    header.height = static_cast<png_uint_32>(image.height);
    header.format = image.has_opacity ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  }
  ~PngWriter() { png_image_free(&header); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  bool encode(const Image& image, void* out, png_alloc_size_t& size) {
    return png_image_write_to_memory(&header, out, &size, 0, image.rgb.data(), 0, nullptr) != 0;
  }
};

}  // namespace

std::string encode_png(const Image& image, const std::string& name) {
  assert(image.rgb.size() ==
         image.bytes_a_pixel() * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  PngWriter writer(image);
  // An upper bound of the file's size, from libpng: incompressible pixels take a few bytes more than their own.
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(writer.header);
  std::string bytes(size, '\0');
  if (!writer.encode(image, bytes.data(), size)) throw FileError(name + ": encode: " + writer.header.message);
  bytes.resize(size);
  return bytes;
}

Image decode_png(std::string_view bytes, std::uint32_t most_columns, std::uint32_t most_rows) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0)
    throw FileError(std::string("decode: ") + header.message);
  const std::unique_ptr<png_image, decltype(&png_image_free)> freed(&header, png_image_free);
  if (header.width > most_columns || header.height > most_rows) throw FileError("decode: the picture is too large");
  const bool has_opacity = (header.format & PNG_FORMAT_FLAG_ALPHA) != 0;  // so far the file's own format
  header.format = has_opacity ? PNG_FORMAT_RGBA : PNG_FORMAT_RGB;
  Image image{static_cast<int>(header.width), static_cast<int>(header.height), {}, has_opacity};
  image.rgb.resize(PNG_IMAGE_SIZE(header));
  if (png_image_finish_read(&header, nullptr, image.rgb.data(), 0, nullptr) == 0)
    throw FileError(std::string("decode: ") + header.message);
  return image;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  write_whole_file(path, encode_png(image, path.string()));
}

}  // namespace alvor
