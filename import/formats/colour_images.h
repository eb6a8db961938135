#pragma once
// The images of a scene's textures.

#include "meshing/scene.h"

#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Decodes images, each once, and halves the largest of them until all have at most 16 million texels together: more would fill
/// memory with what nobody can see in irradiance.
class ColourImages {
 public:
  /// Returns the image that `key` stands for, such as its file or its number; null if it cannot be decoded. Later calls may halve
  /// it.
  std::shared_ptr<const ColourImage> decoded(const std::string& key, std::span<const unsigned char> encoded);
  std::shared_ptr<const ColourImage> decoded(const std::string& key, const std::string* encoded);

  /// Sets the reflectance of a material to `factor` times the image by place; an image of one colour needs no texture. Requires:
  /// an image that decoded() returned.
  void cover(Material& material, const Rgb& factor, std::shared_ptr<const ColourImage> image, Wrap wrap_s, Wrap wrap_t);

  /// Appends a sentence for each image that was halved.
  void append_warnings(std::vector<std::string>& warnings) const;

 private:
  struct Known {
    std::shared_ptr<ColourImage> image;   ///< null: it cannot be decoded
    std::uint32_t columns = 0, rows = 0;  ///< of the file
  };
  /// Properties of an image, found once for all materials that it covers.
  struct Facts {
    std::uint32_t columns = 0;  ///< when they were found: it may be halved later
    bool has_one_colour = false;
    Rgb mean;
  };
  void keep_within_limit();
  const Facts& facts_of(const ColourImage& image);

  std::map<std::string, Known> images_;
  std::map<const ColourImage*, Facts> facts_;
  std::size_t texels_ = 0;
};

/// Returns the image of half the columns and rows, rounded up. Its linear values are means.
ColourImage halved(const ColourImage& image);

/// The copies of materials without their textures, for faces without texture points: these have the texture's mean.
class BareMaterials {
 public:
  /// Returns the number of the copy of a material, which is added to the scene when it is asked for first.
  std::uint32_t of(Scene& scene, std::uint32_t material);
  /// Appends a sentence for each material that has a copy.
  void append_warnings(const Scene& scene, std::vector<std::string>& warnings) const;

 private:
  std::map<std::uint32_t, std::uint32_t> copies_;
};

/// Returns a texture point; one that is no number or far away is moved to the image.
TexturePoint texture_point(double s, double t);

}  // namespace alvor
