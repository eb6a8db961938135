#pragma once
// Turns image files into colours and opacities of textures, and replaces textures by their means where only these count.

#include "meshing/texture.h"
#include "solution/rgb.h"

#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Tells how the alpha of a texture sets the opacity of the surface that carries it. `ignored`: the surface is opaque.
/// `blended`: its opacity is alpha times `factor`, at most 1. `cut`: it is opaque where alpha times `factor` is at least
/// `cutoff`, and elsewhere not there.
struct AlphaUse {
  enum class Kind : unsigned char { ignored, blended, cut } kind = Kind::ignored;
  double factor = 1, cutoff = 0.5;

  bool is_ignored() const { return kind == Kind::ignored; }
  /// Returns the share of a surface that is there where its texture has this alpha, in [0, 1].
  double opacity(double alpha) const {
    if (is_ignored()) return 1;
    return kind == Kind::cut ? double(alpha * factor >= cutoff) : std::clamp(alpha * factor, 0.0, 1.0);
  }
};

/// The means of an image.
struct MeanTexel {
  Rgb colour{1, 1, 1};  ///< of its colours where it is opaque, linear
  double opacity = 1;
  bool has_alpha = false;
  double level = 1;  ///< of its values as they are, mean over bands: for images that hold no colours
};

/// Returns the means of the pixels of an image file (see decode_image()), converted from sRGB to linear. Returns nothing if the
/// image cannot be decoded.
std::optional<MeanTexel> mean_texel(std::span<const unsigned char> encoded, const AlphaUse& alpha = {});
/// Returns the means of a file's bytes; nothing if there are none.
std::optional<MeanTexel> mean_texel(const std::string* encoded, const AlphaUse& alpha = {});

/// Returns the colours of an image file, those of 16 bits cut to 8. The image has opacity where its alpha, used so, makes any
/// texel less than opaque. Returns nothing if the image cannot be decoded. The result may be larger than ColourImage allows.
std::optional<ColourImage> decode_colours(std::span<const unsigned char> encoded, const AlphaUse& alpha = {});

/// Returns a white image whose opacity is `factor` times the alpha of an image file, or, if that has no alpha, times the mean
/// of its three bands. Otherwise as decode_colours().
std::optional<ColourImage> decode_opacity(std::span<const unsigned char> encoded, double factor);

/// Returns `colours` with the opacity of another image, which covers the same area. The result has the size of the larger of the
/// two; of the smaller one it takes the nearest texel.
ColourImage with_opacity(const ColourImage& colours, const ColourImage& opacity);

/// Returns the linear value, in [0, 1], of an sRGB value (IEC 61966-2-1).
double linear_of_srgb_byte(std::uint8_t value);
/// Returns the sRGB value nearest to a linear value in [0, 1].
std::uint8_t srgb_byte_of_linear(double linear);

/// Returns `factor` times the texture's mean colour, or `factor` itself if the texture could not be read. Appends a warning that
/// names `texture`.
Rgb textured(const Rgb& factor, const std::optional<MeanTexel>& mean, const std::string& texture,
             std::vector<std::string>& warnings);

}  // namespace alvor
