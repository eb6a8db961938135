#include "import/formats/colour_images.h"

#include "import/formats/texture_colour.h"

#include <algorithm>
#include <cmath>

namespace alvor {

namespace {

constexpr std::size_t most_texels = 16'000'000;

std::string size_of(std::uint32_t columns, std::uint32_t rows) { return std::to_string(columns) + " x " + std::to_string(rows); }

bool has_one_colour(const ColourImage& image) {
  for (std::size_t i = 3; i < image.texels.size(); ++i)
    if (image.texels[i] != image.texels[i - 3]) return false;
  return true;
}

float on_image(double x) {
  if (!std::isfinite(x)) return 0;
  return static_cast<float>(std::abs(x) <= most_repeats ? x : std::fmod(x, 2));  // two repeats are one of a mirrored image
}

}  // namespace

std::shared_ptr<const ColourImage> ColourImages::decoded(const std::string& name, std::span<const unsigned char> encoded) {
  const auto [found, is_new] = images_.try_emplace(name);
  if (!is_new) return found->second.image;
  auto image = decode_colours(encoded);
  if (!image) return nullptr;
  const std::uint32_t columns = image->columns, rows = image->rows;
  while (image->columns > ColourImage::most_columns || image->rows > ColourImage::most_rows) *image = halved(*image);
  texels_ += image->texel_count();
  found->second = {std::make_shared<ColourImage>(*std::move(image)), columns, rows};
  keep_within_limit();
  return found->second.image;
}

std::shared_ptr<const ColourImage> ColourImages::decoded(const std::string& name, const std::string* encoded) {
  if (!encoded) return nullptr;
  return decoded(name, {reinterpret_cast<const unsigned char*>(encoded->data()), encoded->size()});
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
  if (facts.columns != image.columns) facts = {image.columns, has_one_colour(image), mean_reflectance(image)};
  return facts;
}

void ColourImages::cover(Material& material, const Rgb& factor, std::shared_ptr<const ColourImage> image, Wrap wrap_s,
                         Wrap wrap_t) {
  const Rgb within = lower(upper(factor, {}), Rgb{1, 1, 1});
  const Facts& facts = facts_of(*image);
  material.reflectance = within * facts.mean;
  if (!facts.has_one_colour) material.texture = Texture{std::move(image), within, wrap_s, wrap_t};
}

void ColourImages::append_warnings(std::vector<std::string>& warnings) const {
  for (const auto& [name, known] : images_)
    if (known.image && known.image->columns != known.columns)
      warnings.push_back("texture '" + name + "': " + size_of(known.columns, known.rows) + " texels are averaged to " +
                         size_of(known.image->columns, known.image->rows));
}

ColourImage halved(const ColourImage& image) {
  ColourImage half{(image.columns + 1) / 2, (image.rows + 1) / 2, {}};
  half.texels.reserve(3 * half.texel_count());
  for (std::uint32_t row = 0; row < half.rows; ++row)
    for (std::uint32_t column = 0; column < half.columns; ++column) {
      const std::uint32_t right = std::min(2 * column + 1, image.columns - 1), below = std::min(2 * row + 1, image.rows - 1);
      for (std::size_t band = 0; band < 3; ++band) {
        double sum = 0;
        for (const std::uint32_t r : {2 * row, below})
          for (const std::uint32_t c : {2 * column, right})
            sum += linear_of_srgb_byte(image.texels[3 * (std::size_t{r} * image.columns + c) + band]);
        half.texels.push_back(srgb_byte_of_linear(sum / 4));
      }
    }
  return half;
}

std::uint32_t BareMaterials::of(Scene& scene, std::uint32_t material) {
  const auto [copy, is_new] = copies_.try_emplace(material, static_cast<std::uint32_t>(scene.materials.size()));
  if (is_new) {
    scene.materials.push_back(scene.materials[material]);
    scene.materials.back().texture.reset();
  }
  return copy->second;
}

void BareMaterials::append_warnings(const Scene& scene, std::vector<std::string>& warnings) const {
  for (const auto& [material, copy] : copies_)
    warnings.push_back("material '" + scene.materials[material].name +
                       "': some faces have no texture coordinates; there its texture counts by its mean colour");
}

TexturePoint texture_point(double s, double t) { return {on_image(s), on_image(t)}; }

}  // namespace alvor
