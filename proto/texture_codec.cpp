#include "proto/texture_codec.h"

#include "proto/codec.h"

#include <algorithm>

namespace alvor {

namespace {

constexpr std::size_t most_images = 10'000;
// Texels of all images of a scene together. While the scene is solved a texel takes 15 or 20 bytes.
constexpr std::uint64_t most_texels = 1u << 26;

std::string count_of(std::uint64_t count, const char* unit) { return std::to_string(count) + " " + unit; }

v1::Texture::Wrap encode(Wrap wrap) {
  switch (wrap) {
    case Wrap::repeat: return v1::Texture::REPEAT;
    case Wrap::mirror: return v1::Texture::MIRROR;
    case Wrap::clamp: return v1::Texture::CLAMP;
  }
  return v1::Texture::WRAP_UNSPECIFIED;
}

Wrap decode_wrap(v1::Texture::Wrap wrap) {
  if (wrap == v1::Texture::MIRROR) return Wrap::mirror;
  return wrap == v1::Texture::CLAMP ? Wrap::clamp : Wrap::repeat;
}

v1::Texture encode(const Texture& texture, std::uint32_t image) {
  v1::Texture message;
  message.set_image(image);
  *message.mutable_factor() = encode(texture.factor);
  message.set_wrap_s(encode(texture.wrap_s));
  message.set_wrap_t(encode(texture.wrap_t));
  return message;
}

}  // namespace

std::optional<Fault> ImageAssembler::fault_in(const v1::GeometryChunk& chunk, const std::string& place) const {
  std::uint64_t texels = wanted_texels_, bytes = wanted_bytes_;
  for (const v1::ColourImage& image : chunk.images()) {
    const std::string size = std::to_string(image.columns()) + " x " + std::to_string(image.rows());
    if (image.columns() == 0 || image.rows() == 0 || image.columns() > ColourImage::most_columns ||
        image.rows() > ColourImage::most_rows)
      return Fault{place + "images", "an image has " + size + " texels, 1 x 1 to 8192 x 8192 are possible"};
    texels += std::uint64_t{image.columns()} * image.rows();
    bytes += std::uint64_t{image.columns()} * image.rows() * (image.has_opacity() ? 4 : 3);
  }
  if (texels > most_texels)
    return Fault{place + "images", "the scene has " + count_of(texels, "texels, at most 67108864 are possible")};
  if (texel_bytes_ + chunk.texels().size() > bytes)
    return Fault{place + "texels", "there are " + count_of(texel_bytes_ + chunk.texels().size(), "bytes for ") +
                                       count_of(texels, "texels, which have ") + count_of(bytes, "bytes")};
  const std::size_t images = images_.size() + static_cast<std::size_t>(chunk.images_size());
  if (images > most_images)
    return Fault{place + "images", "the scene has " + count_of(images, "images, at most 10000 are possible")};
  for (const v1::Material& material : chunk.materials())
    if (material.has_texture() && material.texture().image() >= images)
      return Fault{"material '" + material.name() + "'",
                   "image " + std::to_string(material.texture().image()) + " of its texture is not known"};
  const int coordinates = chunk.texture_coordinates_size();
  if (coordinates != 0 && coordinates != 2 * std::int64_t{chunk.corner_vertices_size()})
    return Fault{place + "texture_coordinates",
                 "has " + count_of(static_cast<std::uint64_t>(coordinates), "numbers, needs two for each of ") +
                     count_of(static_cast<std::uint64_t>(chunk.corner_vertices_size()), "corners")};
  const int bands = chunk.corner_colors_size();
  if (bands != 0 && bands != 3 * std::int64_t{chunk.corner_vertices_size()})
    return Fault{place + "corner_colors", "has " +
                                              count_of(static_cast<std::uint64_t>(bands), "numbers, needs three for each of ") +
                                              count_of(static_cast<std::uint64_t>(chunk.corner_vertices_size()), "corners")};
  return std::nullopt;
}

void ImageAssembler::add(const v1::GeometryChunk& chunk) {
  for (const v1::ColourImage& image : chunk.images()) {
    images_.push_back(std::make_shared<ColourImage>(ColourImage{image.columns(), image.rows(), {}, image.has_opacity()}));
    wanted_texels_ += images_.back()->texel_count();
    wanted_bytes_ += images_.back()->byte_count();
  }
  texel_bytes_ += chunk.texels().size();
  std::string_view bytes = chunk.texels();
  for (; !bytes.empty() && complete_ < images_.size(); ++complete_) {
    ColourImage& image = *images_[complete_];
    const std::size_t taken = std::min(bytes.size(), image.byte_count() - image.texels.size());
    image.texels.insert(image.texels.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(taken));
    bytes.remove_prefix(taken);
    if (image.texels.size() < image.byte_count()) return;
    find_most(image);
  }
}

Texture ImageAssembler::decode(const v1::Texture& message) const {
  const Rgb factor = message.has_factor() ? alvor::decode(message.factor()) : Rgb{1, 1, 1};
  return {images_[message.image()], factor, decode_wrap(message.wrap_s()), decode_wrap(message.wrap_t())};
}

ImageList::ImageList(std::span<const Material> materials) {
  for (const Material& material : materials) {
    if (!material.texture) continue;
    const ColourImage* const image = material.texture->image.get();
    if (number_.try_emplace(image, static_cast<std::uint32_t>(images_.size())).second) images_.push_back(image);
  }
}

void ImageList::encode_texture(const Material& material, v1::Material& message) const {
  if (material.texture) *message.mutable_texture() = encode(*material.texture, number_.at(material.texture->image.get()));
}

void ImageSlicer::next(google::protobuf::RepeatedPtrField<v1::ColourImage>& images, std::string& texels, std::int64_t& budget) {
  constexpr std::int64_t bytes_of_image = 16, bytes_of_length = 8;
  for (; image_ < images_.size() && budget > bytes_of_image + bytes_of_length; ++image_, texel_byte_ = 0, is_announced_ = false) {
    const ColourImage& image = *images_[image_];
    if (!is_announced_) {
      v1::ColourImage* const message = images.Add();
      message->set_columns(image.columns);
      message->set_rows(image.rows);
      message->set_has_opacity(image.has_opacity);
      is_announced_ = true;
      budget -= bytes_of_image;
    }
    const std::size_t room = static_cast<std::size_t>(budget - bytes_of_length);
    const std::size_t taken = std::min(room, image.texels.size() - texel_byte_);
    texels.append(reinterpret_cast<const char*>(&image.texels[texel_byte_]), taken);
    texel_byte_ += taken;
    budget -= static_cast<std::int64_t>(taken);
    if (texel_byte_ < image.texels.size()) return;
  }
}

bool MeshImageSlicer::next(v1::ReadImagesResponse& message) {
  message.Clear();
  std::int64_t budget = 1 << 20;
  slicer_.next(*message.mutable_images(), *message.mutable_texels(), budget);
  return !message.texels().empty();
}

}  // namespace alvor
