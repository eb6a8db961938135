#pragma once
// Images of surface colours, and how they lie on faces.

#include "solution/rgb.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace alvor {

/// An image of surface colours: sRGB (IEC 61966-2-1), 8 bits a band, and if it has any opacity of each texel: 255 is all there, 0
/// a hole. Immutable once made; materials share it.
struct ColourImage {
  static constexpr std::uint32_t most_columns = 8192, most_rows = 8192;

  std::uint32_t columns = 0, rows = 0;  ///< > 0
  /// Red, green, blue, and if it has any opacity, of the first texel of the top row, then of the next one.
  std::vector<std::uint8_t> texels;
  bool has_opacity = false;
  /// No texel but holes has a larger red, green or blue: see find_most().
  std::array<std::uint8_t, 3> most{255, 255, 255};

  std::size_t texel_count() const { return std::size_t{columns} * rows; }
  std::size_t bytes_a_texel() const { return has_opacity ? 4 : 3; }
  std::size_t byte_count() const { return bytes_a_texel() * texel_count(); }
  const std::uint8_t* texel(std::uint32_t column, std::uint32_t row) const {
    return &texels[bytes_a_texel() * (std::size_t{row} * columns + column)];
  }
};

/// Sets `most` of an image to its largest values.
void find_most(ColourImage& image);

/// Returns why an image cannot be used.
std::optional<std::string> fault_in(const ColourImage& image);

/// Returns the reflectance that a value of an image stands for: the linear value, but for 255 that of 254, which is 0.991. Light
/// between faces that reflect everything would never fade.
double reflectance_of_texel(std::uint8_t value);
/// Returns the share of the brightest light that a value of an image stands for: the linear value.
double light_of_texel(std::uint8_t value);

/// A surface in the mean over some area.
struct MeanSurface {
  Rgb reflectance;   ///< of what is there
  double cover = 1;  ///< share of the area that is there and no hole
};

/// Returns the mean over all texels. `of_texel` is reflectance_of_texel, or light_of_texel for an image of light: then the
/// result's `reflectance` is light.
MeanSurface mean_surface(const ColourImage& image, double (*of_texel)(std::uint8_t) = reflectance_of_texel);

/// A place on an image: (0, 0) is its upper left corner and (1, 1) its lower right one, as in glTF.
struct TexturePoint {
  float s = 0, t = 0;
  friend bool operator==(const TexturePoint&, const TexturePoint&) = default;
};
/// Coordinates of texture points are at most this in absolute value.
inline constexpr float most_repeats = 1e5F;

/// How an image goes on beyond its edge.
enum class Wrap : std::uint8_t { repeat, mirror, clamp };

/// Returns the number of the texel, of `count` in a row or column, that is seen at position `index` of the endless row.
std::uint32_t wrapped(std::int64_t index, std::uint32_t count, Wrap wrap);

/// A reflectance that varies over a face.
struct Texture {
  std::shared_ptr<const ColourImage> image;
  Rgb factor{1, 1, 1};  ///< multiplies the image; in [0, 1]
  Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;

  /// Returns an upper bound on the reflectance of any place.
  Rgb largest_reflectance() const {
    return factor *
           Rgb{reflectance_of_texel(image->most[0]), reflectance_of_texel(image->most[1]), reflectance_of_texel(image->most[2])};
  }
  /// Returns the reflectance at a point, bilinear between the middles of texels, of what is there.
  Rgb reflectance_at(TexturePoint point) const;
  /// Returns the opacity of the texel at a point, in [0, 1].
  double opacity_at(TexturePoint point) const;
};

}  // namespace alvor
