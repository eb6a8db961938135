#pragma once
// The images of a scene's textures.

#include "import/formats/texture_colour.h"
#include "meshing/scene.h"

#include <cstddef>
#include <functional>
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
  /// Returns the image that `name` stands for, such as its file or its number, with the opacity that this use of its alpha gives
  /// it; null if it cannot be decoded. Later calls may halve it.
  std::shared_ptr<const ColourImage> decoded(const std::string& name, std::span<const unsigned char> encoded,
                                             const AlphaUse& alpha = {});
  std::shared_ptr<const ColourImage> decoded(const std::string& name, const std::string* encoded);

  /// Returns the image that `make` makes when it is called for this name and use first; null if it makes none. `use` tells apart
  /// images that have a name in common; warnings tell only the name. Later calls may halve it.
  std::shared_ptr<const ColourImage> made(const std::string& name, const std::string& use,
                                          const std::function<std::optional<ColourImage>()>& make);

  /// Sets the reflectance of a material to `factor` times the image by place, and cuts out its holes. An image of one colour and
  /// one opacity needs no texture: then returns this opacity, for leave(); otherwise 1. Requires: an image that this object
  /// returned.
  double cover(Material& material, const Rgb& factor, std::shared_ptr<const ColourImage> image, Wrap wrap_s, Wrap wrap_t);

  /// Appends a sentence for each image that was halved.
  void append_warnings(std::vector<std::string>& warnings) const;

 private:
  using Key = std::pair<std::string, std::string>;  // name, use
  struct Known {
    std::shared_ptr<ColourImage> image;   ///< null: it cannot be decoded
    std::uint32_t columns = 0, rows = 0;  ///< of the file; 0 if another entry has the same image
  };
  /// Properties of an image, found once for all materials that it covers.
  struct Facts {
    std::uint32_t columns = 0;  ///< when they were found: it may be halved later
    bool is_uniform = false;    ///< has one colour and one opacity
    MeanSurface mean;
  };
  std::shared_ptr<const ColourImage> add(Known& entry, ColourImage image);
  void keep_within_limit();
  const Facts& facts_of(const ColourImage& image);

  std::map<Key, Known> images_;
  std::map<const ColourImage*, Facts> facts_;
  std::size_t texels_ = 0;
};

/// Returns whether an image has one colour and one opacity.
bool has_equal_texels(const ColourImage& image);

/// Returns the image of half the columns and rows, rounded up. Its linear values are means of what is there, its opacities means.
ColourImage halved(const ColourImage& image);

/// The copies of materials without their textures, for faces without texture points: these have the texture's mean colour and
/// opacity.
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
