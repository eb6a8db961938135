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
  /// Returns the image called `name` (of one file or place in a file); null if it cannot be decoded. Later calls may halve it.
  std::shared_ptr<const ColourImage> decoded(const std::string& name, std::span<const unsigned char> encoded);
  std::shared_ptr<const ColourImage> decoded(const std::string& name, const std::string* encoded);

  /// Sets the reflectance of a material to `factor` times the image by place; an image of one colour needs no texture. Requires:
  /// an image that decoded() returned.
  static void cover(Material& material, const Rgb& factor, std::shared_ptr<const ColourImage> image, Wrap wrap_s, Wrap wrap_t);

  /// Appends a sentence for each image that was halved.
  void append_warnings(std::vector<std::string>& warnings) const;

 private:
  struct Known {
    std::shared_ptr<ColourImage> image;   ///< null: it cannot be decoded
    std::uint32_t columns = 0, rows = 0;  ///< of the file
  };
  void keep_within_limit();

  std::map<std::string, Known> images_;
  std::size_t texels_ = 0;
};

/// Returns the image of half the columns and rows, rounded up. Its linear values are means.
ColourImage halved(const ColourImage& image);

/// Returns a texture point; one that is no number or far away is moved to the image.
TexturePoint texture_point(double s, double t);

}  // namespace alvor
