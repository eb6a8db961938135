#pragma once
// Converts between the messages of the API and textures with their images.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace alvor {

/// Assembles the images of a scene from chunks in order of arrival.
class ImageAssembler {
 public:
  /// Returns the fault in what a chunk says of images, textures, texture coordinates and colours. `place` begins the fault's
  /// place: "chunk 3, ".
  std::optional<Fault> fault_in(const v1::GeometryChunk& chunk, const std::string& place) const;
  /// Appends the images and texels of a chunk. Requires: !fault_in(chunk).
  void add(const v1::GeometryChunk& chunk);
  /// Returns a texture of an image that has arrived, though perhaps not all of its texels.
  Texture decode(const v1::Texture& message) const;

 private:
  std::vector<std::shared_ptr<ColourImage>> images_;
  std::size_t complete_ = 0;                            // images that have all their texels
  std::uint64_t wanted_texels_ = 0, wanted_bytes_ = 0;  // texels of all images that have arrived, and the bytes that they need
  std::uint64_t texel_bytes_ = 0;                       // bytes of texels that have arrived
};

/// The images of a scene's textures, each once, numbered in the order of the materials.
class ImageList {
 public:
  explicit ImageList(std::span<const Material> materials);
  std::span<const ColourImage* const> images() const { return images_; }
  /// Sets the texture of the message, if the material has one. Requires: a material of the list's scene.
  void encode_texture(const Material& material, v1::Material& message) const;

 private:
  std::vector<const ColourImage*> images_;
  std::unordered_map<const ColourImage*, std::uint32_t> number_;
};

/// Cuts images into pieces. The images must outlive it.
class ImageSlicer {
 public:
  explicit ImageSlicer(std::span<const ColourImage* const> images) : images_(images) {}
  bool is_at_start() const { return image_ == 0 && texel_byte_ == 0 && !is_announced_; }
  bool is_done() const { return image_ == images_.size(); }
  /// Appends sizes of images, and bytes of their texels, that take at most `budget` bytes together; reduces it by what they take.
  void next(google::protobuf::RepeatedPtrField<v1::ColourImage>& images, std::string& texels, std::int64_t& budget);

 private:
  std::span<const ColourImage* const> images_;
  std::size_t image_ = 0, texel_byte_ = 0;  // the image that is being sent, and how much of it was
  bool is_announced_ = false;               // its size was sent
};

/// Cuts the images of a mesh's materials into messages well below gRPC's limit of 4 MB. The mesh must outlive it.
class MeshImageSlicer {
 public:
  explicit MeshImageSlicer(std::span<const Material> materials) : list_(materials), slicer_(list_.images()) {}
  MeshImageSlicer(const MeshImageSlicer&) = delete;
  /// Fills in the next message. Returns false if nothing is left.
  bool next(v1::ReadImagesResponse& message);

 private:
  ImageList list_;
  ImageSlicer slicer_;
};

}  // namespace alvor
