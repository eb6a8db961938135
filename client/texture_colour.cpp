#include "client/texture_colour.h"

#include <tiny_gltf.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>

namespace alvor {

namespace {

/// IEC 61966-2-1.
double linear_of_srgb(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

template <class Sample>
std::vector<double> linear_table() {
  std::vector<double> table(std::size_t{std::numeric_limits<Sample>::max()} + 1);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = linear_of_srgb(static_cast<double>(i) / std::numeric_limits<Sample>::max());
  return table;
}

/// Requires: `rgba` holds at least one whole pixel.
template <class Sample>
Rgb mean_of_pixels(std::span<const unsigned char> rgba) {
  const std::vector<double> linear = linear_table<Sample>();
  const std::size_t pixels = rgba.size() / (4 * sizeof(Sample));
  Rgb sum;
  for (std::size_t i = 0; i < pixels; ++i) {
    std::array<Sample, 4> pixel;
    std::memcpy(pixel.data(), rgba.data() + i * sizeof pixel, sizeof pixel);
    sum += {linear[pixel[0]], linear[pixel[1]], linear[pixel[2]]};
  }
  return sum * (1.0 / static_cast<double>(pixels));
}

std::optional<Rgb> mean_of_image(const tinygltf::Image& image) {
  if (image.component != 4 || image.image.empty()) return std::nullopt;
  return image.bits == 16 ? mean_of_pixels<std::uint16_t>(image.image) : mean_of_pixels<std::uint8_t>(image.image);
}

}  // namespace

std::optional<Rgb> mean_colour(std::span<const unsigned char> encoded) {
  if (encoded.empty() || encoded.size() > std::numeric_limits<int>::max()) return std::nullopt;
  tinygltf::Image image;
  std::string error, warning;
  const int size = static_cast<int>(encoded.size());
  if (!tinygltf::LoadImageData(&image, 0, &error, &warning, 0, 0, encoded.data(), size, nullptr)) return std::nullopt;
  return mean_of_image(image);
}

std::optional<Rgb> mean_colour_of_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return std::nullopt;
  std::ifstream stream(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
  return mean_colour({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

Rgb textured(const Rgb& factor, const std::optional<Rgb>& mean, const std::string& texture, std::vector<std::string>& warnings) {
  warnings.push_back(texture + (mean ? " counts by its mean colour" : " cannot be read and is left out"));
  return mean ? factor * *mean : factor;
}

}  // namespace alvor
