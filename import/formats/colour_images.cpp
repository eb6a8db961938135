#include "import/formats/colour_images.h"

#include "import/formats/see_through.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace alvor {

namespace {

constexpr std::size_t most_texels = 16'000'000;

std::string size_of(std::uint32_t columns, std::uint32_t rows) { return std::to_string(columns) + " x " + std::to_string(rows); }

/// Returns a text that differs where two uses of an image's alpha do; none if it is ignored.
std::string text_of(const AlphaUse& alpha) {
  if (alpha.is_ignored()) return "";
  char text[80];
  std::snprintf(text, sizeof text, "%s %.17g %.17g", alpha.kind == AlphaUse::Kind::cut ? "cut" : "blended", alpha.factor,
                alpha.cutoff);
  return text;
}

/// Returns the mean of some texels, weighted by their opacity; if all are holes, their plain mean, so that no dark edge appears.
std::array<std::uint8_t, 4> mean_of_texels(const std::array<const std::uint8_t*, 4>& texels, bool has_opacity) {
  std::array<double, 3> sum{}, plain{};
  double weight = 0;
  for (const std::uint8_t* const texel : texels) {
    const double opacity = has_opacity ? texel[3] : 255;
    weight += opacity;
    for (std::size_t band = 0; band < 3; ++band) {
      const double linear = linear_of_srgb_byte(texel[band]);
      sum[band] += opacity * linear, plain[band] += linear;
    }
  }
  std::array<std::uint8_t, 4> mean{};
  for (std::size_t band = 0; band < 3; ++band)
    mean[band] = srgb_byte_of_linear(weight > 0 ? sum[band] / weight : plain[band] / 4);
  mean[3] = static_cast<std::uint8_t>(std::lround(weight / 4));
  return mean;
}

float on_image(double x) {
  if (!std::isfinite(x)) return 0;
  return static_cast<float>(std::abs(x) <= most_repeats ? x : std::fmod(x, 2));  // two repeats are one of a mirrored image
}

}  // namespace

std::shared_ptr<const ColourImage> ColourImages::decoded(const std::string& name, std::span<const unsigned char> encoded,
                                                         const AlphaUse& alpha) {
  const auto [found, is_new] = images_.try_emplace(Key{name, text_of(alpha)});
  if (!is_new) return found->second.image;
  auto image = decode_colours(encoded, alpha);
  if (!image) return nullptr;
  if (alpha.is_ignored() || image->has_opacity) return add(found->second, *std::move(image));
  Known& opaque = images_[Key{name, ""}];  // all uses that leave the image opaque share it
  if (!opaque.image) add(opaque, *std::move(image));
  found->second.image = opaque.image;
  return opaque.image;
}

std::shared_ptr<const ColourImage> ColourImages::decoded(const std::string& name, const std::string* encoded) {
  if (!encoded) return nullptr;
  return decoded(name, {reinterpret_cast<const unsigned char*>(encoded->data()), encoded->size()});
}

std::shared_ptr<const ColourImage> ColourImages::made(const std::string& name, const std::string& use,
                                                      const std::function<std::optional<ColourImage>()>& make) {
  const auto [found, is_new] = images_.try_emplace(Key{name, use});
  if (!is_new) return found->second.image;
  auto image = make();
  return image ? add(found->second, *std::move(image)) : nullptr;
}

std::shared_ptr<const ColourImage> ColourImages::add(Known& entry, ColourImage image) {
  const std::uint32_t columns = image.columns, rows = image.rows;
  while (image.columns > ColourImage::most_columns || image.rows > ColourImage::most_rows) image = halved(image);
  find_most(image);
  texels_ += image.texel_count();
  entry = {std::make_shared<ColourImage>(std::move(image)), columns, rows};
  keep_within_limit();
  return entry.image;
}

void ColourImages::keep_within_limit() {
  const auto texels_of = [](const auto& item) { return item.second.image ? item.second.image->texel_count() : 0; };
  while (texels_ > most_texels) {
    ColourImage& largest = *std::ranges::max_element(images_, {}, texels_of)->second.image;
    texels_ -= largest.texel_count();
    largest = halved(largest);
    texels_ += largest.texel_count();
  }
}

const ColourImages::Facts& ColourImages::facts_of(const ColourImage& image) {
  Facts& facts = facts_[&image];
  if (facts.columns == image.columns) return facts;
  const MeanSurface mean = mean_surface(image);
  return facts = {image.columns, mean.cover == 0 || has_equal_texels(image), mean};
}

double ColourImages::cover(Material& material, const Rgb& factor, std::shared_ptr<const ColourImage> image, Wrap wrap_s,
                           Wrap wrap_t) {
  const Rgb within = lower(upper(factor, {}), Rgb{1, 1, 1});
  const Facts& facts = facts_of(*image);
  material.reflectance = within * facts.mean.reflectance;
  if (facts.is_uniform) return facts.mean.cover;
  const bool is_black = within.is_zero() && !image->has_opacity;
  if (!is_black) material.texture = Texture{std::move(image), within, wrap_s, wrap_t};
  return 1;
}

void ColourImages::append_warnings(std::vector<std::string>& warnings) const {
  for (const auto& [key, known] : images_)
    if (known.image && known.columns > 0 && known.image->columns != known.columns)
      warnings.push_back("texture '" + key.first + "': " + size_of(known.columns, known.rows) + " texels are averaged to " +
                         size_of(known.image->columns, known.image->rows));
}

bool has_equal_texels(const ColourImage& image) {
  const std::size_t stride = image.bytes_a_texel();
  for (std::size_t i = stride; i < image.texels.size(); ++i)
    if (image.texels[i] != image.texels[i - stride]) return false;
  return true;
}

ColourImage halved(const ColourImage& image) {
  ColourImage half{(image.columns + 1) / 2, (image.rows + 1) / 2, {}, image.has_opacity};
  half.texels.reserve(half.byte_count());
  const auto bytes = static_cast<std::ptrdiff_t>(image.bytes_a_texel());
  for (std::uint32_t row = 0; row < half.rows; ++row)
    for (std::uint32_t column = 0; column < half.columns; ++column) {
      const std::uint32_t left = 2 * column, right = std::min(left + 1, image.columns - 1);
      const std::uint32_t above = 2 * row, below = std::min(above + 1, image.rows - 1);
      const auto mean = mean_of_texels(
          {image.texel(left, above), image.texel(right, above), image.texel(left, below), image.texel(right, below)},
          image.has_opacity);
      half.texels.insert(half.texels.end(), mean.begin(), mean.begin() + bytes);
    }
  find_most(half);
  return half;
}

std::uint32_t BareMaterials::of(Scene& scene, std::uint32_t material) {
  const auto [known, is_new] = copies_.try_emplace(material, static_cast<std::uint32_t>(scene.materials.size()));
  if (is_new) {
    Material copy = scene.materials[material];
    const double cover = copy.has_cutout() ? mean_surface(*copy.texture->image).cover : 1;
    copy.texture.reset();
    if (cover < 1) leave(copy, cover);
    scene.materials.push_back(std::move(copy));
  }
  return known->second;
}

void BareMaterials::append_warnings(const Scene& scene, std::vector<std::string>& warnings) const {
  for (const auto& [material, copy] : copies_)
    warnings.push_back("material '" + scene.materials[material].name +
                       "': some faces have no texture coordinates; there its texture counts by its mean colour" +
                       (scene.materials[material].has_cutout() ? " and opacity" : ""));
}

TexturePoint texture_point(double s, double t) { return {on_image(s), on_image(t)}; }

}  // namespace alvor
