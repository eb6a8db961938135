#pragma once
// Textures count by their mean colour: a patch has one reflectance and one emission.

#include "solution/rgb.h"

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace alvor {

/// Mean of the pixels of an encoded image (PNG, JPEG, ...), linearised from sRGB; alpha is left out. Nothing if it cannot be
/// decoded.
std::optional<Rgb> mean_colour(std::span<const unsigned char> encoded);
std::optional<Rgb> mean_colour_of_file(const std::filesystem::path& path);

/// `factor` under a texture of this mean colour; `texture` names it in the warning. One that could not be read changes nothing.
Rgb textured(const Rgb& factor, const std::optional<Rgb>& mean, const std::string& texture, std::vector<std::string>& warnings);

}  // namespace alvor
