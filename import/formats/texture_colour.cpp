#include "import/formats/texture_colour.h"

#include "import/formats/image_file.h"
#include "solution/srgb.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace alvor {

namespace {

template <class Sample>
std::vector<double> linear_table() {
  std::vector<double> table(std::size_t{std::numeric_limits<Sample>::max()} + 1);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = linear_of_srgb(static_cast<double>(i) / std::numeric_limits<Sample>::max());
  return table;
}

/// Returns the means of pixels of four samples each. Requires: there are pixels.
template <class Sample>
MeanTexel mean_of_pixels(const ImagePixels& image, const AlphaUse& alpha) {
  const std::vector<double> linear = linear_table<Sample>();
  constexpr double most = std::numeric_limits<Sample>::max();
  Rgb sum;
  double opaque = 0, level = 0;
  const std::span<const Sample> samples = image.samples<Sample>();
  for (std::size_t i = 0; i < samples.size(); i += 4) {
    const Sample* const pixel = &samples[i];
    const double opacity = alpha.opacity(pixel[3] / most);
    sum += opacity * Rgb{linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]};
    opaque += opacity;
    level += (pixel[0] + pixel[1] + pixel[2]) / (3 * most);
  }
  const auto pixels = static_cast<double>(image.pixel_count());
  return {opaque > 0 ? sum * (1 / opaque) : Rgb{}, opaque / pixels, image.has_alpha, level / pixels};
}

/// Returns an image whose texels are these pixels: if they have four samples, its opacity is their alpha. Requires: samples of 8
/// bits.
ColourImage image_of(const ImagePixels& pixels) {
  const std::span<const std::uint8_t> samples = pixels.samples<std::uint8_t>();
  return {pixels.columns, pixels.rows, {samples.begin(), samples.end()}, pixels.channels == 4};
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
  const auto pixels = decode_image(encoded, {.channels = 4, .may_have_16_bits = true});
  if (!pixels) return std::nullopt;
  return pixels->has_16_bits ? mean_of_pixels<std::uint16_t>(*pixels, alpha) : mean_of_pixels<std::uint8_t>(*pixels, alpha);
}

std::optional<ColourImage> decode_colours(std::span<const unsigned char> encoded, const AlphaUse& alpha) {
  auto pixels = decode_image(encoded, {.channels = alpha.is_ignored() ? std::size_t{3} : std::size_t{4}});
  if (!pixels) return std::nullopt;
  ColourImage image = image_of(*pixels);
  pixels.reset();
  if (!image.has_opacity) return image;
  std::array<std::uint8_t, 256> opacity;
  for (std::size_t value = 0; value < opacity.size(); ++value)
    opacity[value] = byte_of(alpha.opacity(static_cast<double>(value) / 255));
  for (std::size_t i = 3; i < image.texels.size(); i += 4) image.texels[i] = opacity[image.texels[i]];
  return without_full_opacity(std::move(image));
}

std::optional<ColourImage> decode_opacity(std::span<const unsigned char> encoded, double factor) {
  auto pixels = decode_image(encoded, {.channels = 4});
  if (!pixels) return std::nullopt;
  const bool has_alpha = pixels->has_alpha;
  ColourImage image = image_of(*pixels);
  pixels.reset();
  std::vector<std::uint8_t>& texels = image.texels;
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    const double value = has_alpha ? texels[i + 3] : (texels[i] + texels[i + 1] + texels[i + 2]) / 3.0;
    std::fill_n(&texels[i], 3, std::uint8_t{255});
    texels[i + 3] = byte_of(factor * value / 255);
  }
  return without_full_opacity(std::move(image));
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
