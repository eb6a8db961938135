#pragma once
// Replaces textures by their mean colour, because a patch has one reflectance and one emission.

#include "solution/rgb.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Returns the mean of the pixels of an encoded image (PNG, JPEG, ...), converted from sRGB to linear; alpha is ignored. Returns
/// nothing if the image cannot be decoded.
std::optional<Rgb> mean_colour(std::span<const unsigned char> encoded);
/// Returns the mean colour of a file's bytes; nothing if there are none.
std::optional<Rgb> mean_colour(const std::string* encoded);

/// Returns `factor` times the texture's mean colour, or `factor` itself if the texture could not be read. Appends a warning that
/// names `texture`.
Rgb textured(const Rgb& factor, const std::optional<Rgb>& mean, const std::string& texture, std::vector<std::string>& warnings);

}  // namespace alvor
