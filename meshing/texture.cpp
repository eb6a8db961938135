#include "meshing/texture.h"

#include "solution/srgb.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace alvor {

namespace {

std::array<double, 256> reflectance_by_value() {
  std::array<double, 256> table;
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = linear_of_srgb(static_cast<double>(std::min<std::size_t>(i, 254)) / 255);
  return table;
}

constexpr double opaque = 255;

/// The reflectance of some texels, weighted by how much of them is there.
struct Weighted {
  Rgb reflectance;
  double weight = 0;
};

Weighted weighted(const ColourImage& image, std::uint32_t column, std::uint32_t row) {
  const std::uint8_t* const texel = image.texel(column, row);
  const double weight = image.has_opacity ? texel[3] / opaque : 1;
  return {weight * Rgb{reflectance_of_texel(texel[0]), reflectance_of_texel(texel[1]), reflectance_of_texel(texel[2])}, weight};
}

/// The two texels between whose middles a point lies, and the weight of the second.
struct Between {
  Between(double position, std::uint32_t count, Wrap wrap) {
    const double before = std::floor(position * count - 0.5);
    first = wrapped(static_cast<std::int64_t>(before), count, wrap);
    second = wrapped(static_cast<std::int64_t>(before) + 1, count, wrap);
    weight = position * count - 0.5 - before;
  }
  std::uint32_t first, second;
  double weight;
};

Weighted mix(const Weighted& a, const Weighted& b, double share) {
  return {(1 - share) * a.reflectance + share * b.reflectance, (1 - share) * a.weight + share * b.weight};
}

}  // namespace

std::optional<std::string> fault_in(const ColourImage& image) {
  const std::string size = std::to_string(image.columns) + " x " + std::to_string(image.rows);
  if (image.columns == 0 || image.rows == 0) return "its image has no texels";
  if (image.columns > ColourImage::most_columns || image.rows > ColourImage::most_rows)
    return "its image has " + size + " texels, at most 8192 x 8192 are possible";
  if (image.texels.size() != image.byte_count())
    return "its image of " + size + " texels has " + std::to_string(image.texels.size()) + " bytes, needs " +
           std::to_string(image.byte_count());
  return std::nullopt;
}

void find_most(ColourImage& image) {
  image.most = {};
  for (std::size_t i = 0; i < image.texels.size(); i += image.bytes_a_texel())
    for (std::size_t band = 0; band < 3; ++band)
      if (!image.has_opacity || image.texels[i + 3] > 0) image.most[band] = std::max(image.most[band], image.texels[i + band]);
}

double reflectance_of_texel(std::uint8_t value) {
  static const std::array<double, 256> table = reflectance_by_value();
  return table[value];
}

double light_of_texel(std::uint8_t value) {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> light{};
    for (std::size_t v = 0; v < light.size(); ++v) light[v] = linear_of_srgb(static_cast<double>(v) / 255);
    return light;
  }();
  return table[value];
}

MeanSurface mean_surface(const ColourImage& image, double (*of_texel)(std::uint8_t)) {
  std::array<std::array<std::uint64_t, 256>, 3> count{};  // of texels by value, each counted by its opacity
  std::uint64_t there = 0;
  const std::size_t stride = image.bytes_a_texel();
  for (std::size_t i = 0; i < image.texels.size(); i += stride) {
    const std::uint64_t opacity = image.has_opacity ? image.texels[i + 3] : static_cast<std::uint64_t>(opaque);
    there += opacity;
    for (std::size_t band = 0; band < 3; ++band) count[band][image.texels[i + band]] += opacity;
  }
  std::array<double, 3> sum{};
  for (std::size_t band = 0; band < 3; ++band)
    for (std::size_t value = 0; value < 256; ++value)
      sum[band] += static_cast<double>(count[band][value]) * of_texel(static_cast<std::uint8_t>(value));
  const auto weight = static_cast<double>(there);
  return {there > 0 ? Rgb{sum[0], sum[1], sum[2]} * (1 / weight) : Rgb{},
          weight / (opaque * static_cast<double>(image.texel_count()))};
}

std::uint32_t wrapped(std::int64_t index, std::uint32_t count, Wrap wrap) {
  const std::int64_t n = count, period = wrap == Wrap::mirror ? 2 * n : n;
  if (wrap == Wrap::clamp) return static_cast<std::uint32_t>(std::clamp<std::int64_t>(index, 0, n - 1));
  const std::int64_t rest = (index % period + period) % period;
  return static_cast<std::uint32_t>(rest < n ? rest : period - 1 - rest);
}

Rgb Texture::reflectance_at(TexturePoint point) const {
  const Between s(double{point.s}, image->columns, wrap_s), t(double{point.t}, image->rows, wrap_t);
  const auto row = [&](std::uint32_t r) { return mix(weighted(*image, s.first, r), weighted(*image, s.second, r), s.weight); };
  const Weighted here = mix(row(t.first), row(t.second), t.weight);
  return here.weight > 0 ? factor * here.reflectance * (1 / here.weight) : Rgb{};
}

double Texture::opacity_at(TexturePoint point) const {
  if (!image->has_opacity) return 1;
  const auto index = [](float position, std::uint32_t count) {
    return static_cast<std::int64_t>(std::floor(double{position} * count));
  };
  return image->texel(wrapped(index(point.s, image->columns), image->columns, wrap_s),
                      wrapped(index(point.t, image->rows), image->rows, wrap_t))[3] /
         opaque;
}

}  // namespace alvor
