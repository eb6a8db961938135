#pragma once
// Writes OpenEXR images of light.

#include "solution/rgb.h"

#include <span>
#include <string>

namespace alvor {

/// Returns the bytes of an OpenEXR image: channels R, G and B as half floats, rows from the top. Values beyond 65 504 become
/// that. Requires: texels.size() == columns * rows.
std::string encode_exr(int columns, int rows, std::span<const RgbF> texels);
/// Returns the bytes of an OpenEXR image of one channel, Y, otherwise as encode_exr() does. Requires: values.size() == columns *
/// rows.
std::string encode_grey_exr(int columns, int rows, std::span<const float> values);

}  // namespace alvor
