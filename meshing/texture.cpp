#include "meshing/texture.h"

#include "solution/srgb.h"

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

Rgb reflectance_of(const ColourImage& image, std::uint32_t column, std::uint32_t row) {
  const std::uint8_t* const texel = &image.texels[3 * (std::size_t{row} * image.columns + column)];
  return {reflectance_of_texel(texel[0]), reflectance_of_texel(texel[1]), reflectance_of_texel(texel[2])};
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

Rgb mix(const Rgb& a, const Rgb& b, double weight) { return (1 - weight) * a + weight * b; }

}  // namespace

std::optional<std::string> fault_in(const ColourImage& image) {
  const std::string size = std::to_string(image.columns) + " x " + std::to_string(image.rows);
  if (image.columns == 0 || image.rows == 0) return "its image has no texels";
  if (image.columns > ColourImage::most_columns || image.rows > ColourImage::most_rows)
    return "its image has " + size + " texels, at most 8192 x 8192 are possible";
  if (image.texels.size() != 3 * image.texel_count())
    return "its image of " + size + " texels has " + std::to_string(image.texels.size()) + " bytes, needs " +
           std::to_string(3 * image.texel_count());
  return std::nullopt;
}

double reflectance_of_texel(std::uint8_t value) {
  static const std::array<double, 256> table = reflectance_by_value();
  return table[value];
}

Rgb mean_reflectance(const ColourImage& image) {
  std::array<std::array<std::uint64_t, 256>, 3> count{};
  for (std::size_t i = 0; i < image.texels.size(); ++i) ++count[i % 3][image.texels[i]];
  std::array<double, 3> sum{};
  for (std::size_t band = 0; band < 3; ++band)
    for (std::size_t value = 0; value < 256; ++value)
      sum[band] += static_cast<double>(count[band][value]) * reflectance_of_texel(static_cast<std::uint8_t>(value));
  return Rgb{sum[0], sum[1], sum[2]} * (1 / static_cast<double>(image.texel_count()));
}

std::uint32_t wrapped(std::int64_t index, std::uint32_t count, Wrap wrap) {
  const std::int64_t n = count, period = wrap == Wrap::mirror ? 2 * n : n;
  if (wrap == Wrap::clamp) return static_cast<std::uint32_t>(std::clamp<std::int64_t>(index, 0, n - 1));
  const std::int64_t rest = (index % period + period) % period;
  return static_cast<std::uint32_t>(rest < n ? rest : period - 1 - rest);
}

Rgb Texture::reflectance_at(TexturePoint point) const {
  const Between s(double{point.s}, image->columns, wrap_s), t(double{point.t}, image->rows, wrap_t);
  const auto row = [&](std::uint32_t r) {
    return mix(reflectance_of(*image, s.first, r), reflectance_of(*image, s.second, r), s.weight);
  };
  return factor * mix(row(t.first), row(t.second), t.weight);
}

}  // namespace alvor
