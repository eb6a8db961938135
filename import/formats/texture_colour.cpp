#include "import/formats/texture_colour.h"

#include "solution/srgb.h"

#include <array>
#include <cstddef>
#include <cstdlib>

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

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace alvor {

namespace {

/// Limit of decoded pixels: a file of a few kilobytes can ask for any number. Textures have at most 16 384 x 16 384.
#ifdef ALVOR_FUZZING
constexpr std::size_t most_pixels = 1 << 20;  // a fuzzer soon asks for the most, and would only fill memory
#else
constexpr std::size_t most_pixels = 1 << 28;
#endif
/// Allocations of stb_image beside the file and the pixels: tables, and blocks of 16 x 16 pixels at the edges.
constexpr std::size_t bytes_beside = 1 << 24;

template <class Sample>
std::vector<double> linear_table() {
  std::vector<double> table(std::size_t{std::numeric_limits<Sample>::max()} + 1);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = linear_of_srgb(static_cast<double>(i) / std::numeric_limits<Sample>::max());
  return table;
}

using Pixels = std::unique_ptr<void, decltype(&stbi_image_free)>;

/// Returns the means of `count` pixels of four samples each. Requires: count > 0.
template <class Sample>
MeanTexel mean_of_pixels(const Pixels& rgba, std::size_t count, const AlphaUse& alpha) {
  const std::vector<double> linear = linear_table<Sample>();
  const Sample* pixel = static_cast<const Sample*>(rgba.get());
  constexpr double most = std::numeric_limits<Sample>::max();
  Rgb sum;
  double opaque = 0, level = 0;
  for (std::size_t i = 0; i < count; ++i, pixel += 4) {
    const double opacity = alpha.opacity(pixel[3] / most);
    sum += opacity * Rgb{linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]};
    opaque += opacity;
    level += (pixel[0] + pixel[1] + pixel[2]) / (3 * most);
  }
  const auto pixels = static_cast<double>(count);
  return {opaque > 0 ? sum * (1 / opaque) : Rgb{}, opaque / pixels, false, level / pixels};
}

/// The first lines of an encoded image.
struct Header {
  int width = 0, height = 0, channels = 0;
  std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
};

/// Reads the header of an image, and allows stb_image the memory to decode it. Returns nothing if it is too large or no image.
std::optional<Header> open_image(std::span<const unsigned char> encoded) {
  if (encoded.empty() || encoded.size() > std::numeric_limits<int>::max()) return std::nullopt;
  Header header;
  most_bytes = bytes_beside;
  const bool is_image = stbi_info_from_memory(encoded.data(), static_cast<int>(encoded.size()), &header.width, &header.height,
                                              &header.channels) != 0;
  if (!is_image || header.width <= 0 || header.height <= 0 || header.count() > most_pixels) return std::nullopt;
  most_bytes += 2 * (encoded.size() + header.count() * 4 * sizeof(std::uint16_t));  // buffers that are too small are doubled
  return header;
}

/// An image as it is decoded: of four channels, its opacity is its alpha.
struct Decoded {
  ColourImage image;
  bool has_alpha = false;
};

/// Returns the image in 8 bits. Requires: channels is 3 or 4.
std::optional<Decoded> decode_bytes(std::span<const unsigned char> encoded, int channels) {
  auto header = open_image(encoded);
  if (!header) return std::nullopt;
  auto& [width, height, in_file] = *header;
  const Pixels pixels(
      stbi_load_from_memory(encoded.data(), static_cast<int>(encoded.size()), &width, &height, &in_file, channels),
      stbi_image_free);
  if (!pixels) return std::nullopt;
  ColourImage image{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height), {}, channels == 4};
  const auto* const bytes = static_cast<const std::uint8_t*>(pixels.get());
  image.texels.assign(bytes, bytes + image.byte_count());
  return Decoded{std::move(image), in_file == 2 || in_file == 4};
}

/// Returns the byte nearest to a share in [0, 1]; 255 for NaN.
std::uint8_t byte_of(double share) {
  return share < 1 ? static_cast<std::uint8_t>(std::lround(255 * std::max(0.0, share))) : 255;
}

/// Returns an image without the opacity of its texels if they are all opaque. Requires: image.has_opacity.
ColourImage without_full_opacity(ColourImage image) {
  std::vector<std::uint8_t>& texels = image.texels;
  for (std::size_t i = 3; i < texels.size(); i += 4)
    if (texels[i] != 255) return image;
  const std::size_t count = image.texel_count();
  for (std::size_t t = 1; t < count; ++t) std::copy_n(&texels[4 * t], 3, &texels[3 * t]);
  texels.resize(3 * count);
  texels.shrink_to_fit();
  image.has_opacity = false;
  return image;
}

}  // namespace

std::optional<MeanTexel> mean_texel(std::span<const unsigned char> encoded, const AlphaUse& alpha) {
  auto header = open_image(encoded);
  if (!header) return std::nullopt;
  auto& [width, height, channels] = *header;
  const unsigned char* const bytes = encoded.data();
  const int size = static_cast<int>(encoded.size());
  const bool is_deep = stbi_is_16_bit_from_memory(bytes, size) != 0;
  const Pixels rgba(is_deep ? static_cast<void*>(stbi_load_16_from_memory(bytes, size, &width, &height, &channels, 4))
                            : stbi_load_from_memory(bytes, size, &width, &height, &channels, 4),
                    stbi_image_free);
  if (!rgba) return std::nullopt;
  const std::size_t count = header->count();
  MeanTexel mean = is_deep ? mean_of_pixels<std::uint16_t>(rgba, count, alpha) : mean_of_pixels<std::uint8_t>(rgba, count, alpha);
  mean.has_alpha = channels == 2 || channels == 4;
  return mean;
}

std::optional<ColourImage> decode_colours(std::span<const unsigned char> encoded, const AlphaUse& alpha) {
  auto decoded = decode_bytes(encoded, alpha.is_ignored() ? 3 : 4);
  if (!decoded) return std::nullopt;
  ColourImage& image = decoded->image;
  if (!image.has_opacity) return std::move(image);
  std::array<std::uint8_t, 256> opacity;
  for (std::size_t value = 0; value < opacity.size(); ++value)
    opacity[value] = byte_of(alpha.opacity(static_cast<double>(value) / 255));
  for (std::size_t i = 3; i < image.texels.size(); i += 4) image.texels[i] = opacity[image.texels[i]];
  return without_full_opacity(std::move(image));
}

std::optional<ColourImage> decode_opacity(std::span<const unsigned char> encoded, double factor) {
  auto decoded = decode_bytes(encoded, 4);
  if (!decoded) return std::nullopt;
  std::vector<std::uint8_t>& texels = decoded->image.texels;
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    const double value = decoded->has_alpha ? texels[i + 3] : (texels[i] + texels[i + 1] + texels[i + 2]) / 3.0;
    std::fill_n(&texels[i], 3, std::uint8_t{255});
    texels[i + 3] = byte_of(factor * value / 255);
  }
  return without_full_opacity(std::move(decoded->image));
}

ColourImage with_opacity(const ColourImage& colours, const ColourImage& opacity) {
  if (!opacity.has_opacity) return colours;
  const ColourImage& larger = colours.texel_count() < opacity.texel_count() ? opacity : colours;
  ColourImage image{larger.columns, larger.rows, {}, true};
  image.texels.reserve(image.byte_count());
  // Returns the number of the texel, of `of`, in which the middle of texel `index` of the result lies.
  const auto nearest = [](std::uint32_t index, std::uint32_t count, std::uint32_t of) {
    return static_cast<std::uint32_t>((2 * std::uint64_t{index} + 1) * of / (2 * std::uint64_t{count}));
  };
  for (std::uint32_t row = 0; row < image.rows; ++row)
    for (std::uint32_t column = 0; column < image.columns; ++column) {
      const auto texel_of = [&](const ColourImage& source) {
        return source.texel(nearest(column, image.columns, source.columns), nearest(row, image.rows, source.rows));
      };
      const std::uint8_t* const colour = texel_of(colours);
      image.texels.insert(image.texels.end(), colour, colour + 3);
      image.texels.push_back(texel_of(opacity)[3]);
    }
  return without_full_opacity(std::move(image));
}

double linear_of_srgb_byte(std::uint8_t value) {
  static const std::vector<double> table = linear_table<std::uint8_t>();
  return table[value];
}

std::uint8_t srgb_byte_of_linear(double linear) {
  constexpr int finest = 65535;  // fine enough for the darkest steps, of 1 / 3295
  static const std::vector<std::uint8_t> table = [] {
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i <= finest; ++i)
      bytes.push_back(static_cast<std::uint8_t>(std::lround(255 * srgb_of_linear(static_cast<double>(i) / finest))));
    return bytes;
  }();
  return table[static_cast<std::size_t>(std::lround(finest * std::clamp(linear, 0.0, 1.0)))];
}

std::optional<MeanTexel> mean_texel(const std::string* encoded, const AlphaUse& alpha) {
  if (!encoded) return std::nullopt;
  return mean_texel({reinterpret_cast<const unsigned char*>(encoded->data()), encoded->size()}, alpha);
}

Rgb textured(const Rgb& factor, const std::optional<MeanTexel>& mean, const std::string& texture,
             std::vector<std::string>& warnings) {
  const char* const treatment = mean ? " counts by its mean colour" : " cannot be read and is left out";
  warnings.push_back(texture + treatment);
  return mean ? factor * mean->colour : factor;
}

}  // namespace alvor
