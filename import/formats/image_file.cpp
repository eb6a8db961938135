#include "import/formats/image_file.h"

#include <cassert>
#include <limits>
#include <string_view>

namespace {

/// The largest allocation of stb_image while it reads the image at hand. It believes the lengths that a file claims: a PNG of a
/// hundred bytes can ask for a gigabyte.
thread_local std::size_t most_bytes = 0;

void* allocate(std::size_t bytes) { return bytes <= most_bytes ? std::malloc(bytes) : nullptr; }
void* reallocate(void* old, std::size_t bytes) { return bytes <= most_bytes ? std::realloc(old, bytes) : nullptr; }

}  // namespace

#define STBI_MALLOC(bytes) allocate(bytes)
#define STBI_REALLOC(old, bytes) reallocate(old, bytes)
#define STBI_FREE(old) std::free(old)

// stb_image's functions are static here: libdraco, which Assimp loads, exports functions of the same names.
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#define STBI_NO_STDIO
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <webp/decode.h>

namespace alvor {

namespace {

/// Limit of decoded pixels: a file of a few kilobytes can ask for any number. Textures have at most 16 384 x 16 384.
#ifdef ALVOR_FUZZING
constexpr std::size_t most_pixels = 1 << 20;       // a fuzzer soon asks for the most, and would only fill memory
constexpr std::size_t most_webp_pixels = 1 << 13;  // for these libwebp's tables have up to 41 MB, see decode_webp()
#else
constexpr std::size_t most_pixels = 1 << 28;
constexpr std::size_t most_webp_pixels = most_pixels;
#endif
/// Allocations of stb_image beside the file and the pixels: tables, and blocks of 16 x 16 pixels at the edges.
constexpr std::size_t bytes_beside = 1 << 24;

/// Lossless WebP needs no bits for pixels of one colour: 32 bytes can hold 2^28 pixels, which take 7 s and 2 GB. Above 2^24
/// pixels (4096 x 4096) a file must be as long as a PNG of one bit a pixel would be at least: deflate holds at most 1032 bytes in
/// one.
constexpr std::size_t most_webp_pixels_of_any_file = 1 << 24, most_webp_pixels_a_byte = 8 * 1032;

std::optional<ImagePixels> decode_by_stb(std::span<const unsigned char> encoded, const WantedPixels& wanted) {
  if (encoded.size() > std::numeric_limits<int>::max()) return std::nullopt;
  const unsigned char* const bytes = encoded.data();
  const int size = static_cast<int>(encoded.size());
  int width = 0, height = 0, in_file = 0;
  most_bytes = bytes_beside;
  if (stbi_info_from_memory(bytes, size, &width, &height, &in_file) == 0 || width <= 0 || height <= 0) return std::nullopt;
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (count > most_pixels) return std::nullopt;
  most_bytes += 2 * (encoded.size() + count * 4 * sizeof(std::uint16_t));  // buffers that are too small are doubled
  const bool is_deep = wanted.may_have_16_bits && stbi_is_16_bit_from_memory(bytes, size) != 0;
  const int channels = static_cast<int>(wanted.channels);
  ImagePixels::Memory memory(is_deep
                                 ? static_cast<void*>(stbi_load_16_from_memory(bytes, size, &width, &height, &in_file, channels))
                                 : stbi_load_from_memory(bytes, size, &width, &height, &in_file, channels));
  if (!memory) return std::nullopt;
  return ImagePixels{static_cast<std::uint32_t>(width),
                     static_cast<std::uint32_t>(height),
                     wanted.channels,
                     in_file == 2 || in_file == 4,
                     is_deep,
                     std::move(memory)};
}

bool is_webp(std::span<const unsigned char> encoded) {
  const std::string_view bytes(reinterpret_cast<const char*>(encoded.data()), encoded.size());
  return bytes.size() >= 12 && bytes.starts_with("RIFF") && bytes.substr(8, 4) == "WEBP";
}

/// Returns whether the file has one picture, of so many pixels that it may be decoded.
bool is_allowed(const WebPBitstreamFeatures& found, std::size_t file_bytes) {
  if (found.has_animation || found.width <= 0 || found.height <= 0) return false;
  const std::size_t count = static_cast<std::size_t>(found.width) * static_cast<std::size_t>(found.height);
  return count <= most_webp_pixels && (count <= most_webp_pixels_of_any_file || count / most_webp_pixels_a_byte <= file_bytes);
}

/// libwebp decodes into memory of ours, and allocates by itself: at most 4 bytes a pixel; and for lossless images tables of 20 KB
/// for each 4 x 4 pixels, for at most 65 536 of them, 1.3 GB. Beyond this the importer's address space is its limit: then the
/// image cannot be decoded. It starts no threads, which the importer's sandbox would not let it.
std::optional<ImagePixels> decode_webp(std::span<const unsigned char> encoded, const WantedPixels& wanted) {
  WebPDecoderConfig config;
  if (!WebPInitDecoderConfig(&config)) return std::nullopt;
  if (WebPGetFeatures(encoded.data(), encoded.size(), &config.input) != VP8_STATUS_OK) return std::nullopt;
  if (!is_allowed(config.input, encoded.size())) return std::nullopt;
  ImagePixels pixels{static_cast<std::uint32_t>(config.input.width),
                     static_cast<std::uint32_t>(config.input.height),
                     wanted.channels,
                     config.input.has_alpha != 0,
                     false,
                     {}};
  const std::size_t bytes = pixels.pixel_count() * pixels.channels;
  pixels.memory.reset(std::malloc(bytes));
  if (!pixels.memory) return std::nullopt;
  auto* const samples = static_cast<std::uint8_t*>(pixels.memory.get());
  config.options.use_threads = 0;
  config.output.colorspace = pixels.channels == 4 ? MODE_RGBA : MODE_RGB;
  config.output.is_external_memory = 1;
  config.output.u.RGBA = {samples, static_cast<int>(pixels.columns * pixels.channels), bytes};
  const bool is_decoded = WebPDecode(encoded.data(), encoded.size(), &config) == VP8_STATUS_OK;
  WebPFreeDecBuffer(&config.output);
  if (!is_decoded) return std::nullopt;
  // A lossless file that says it has no alpha may hold some.
  if (pixels.channels == 4 && !pixels.has_alpha)
    for (std::size_t i = 3; i < bytes; i += 4) samples[i] = 255;
  return pixels;
}

}  // namespace

std::optional<ImagePixels> decode_image(std::span<const unsigned char> encoded, const WantedPixels& wanted) {
  assert(wanted.channels == 3 || wanted.channels == 4);
  if (encoded.empty()) return std::nullopt;
  return is_webp(encoded) ? decode_webp(encoded, wanted) : decode_by_stb(encoded, wanted);
}

}  // namespace alvor
