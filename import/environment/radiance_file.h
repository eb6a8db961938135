#pragma once
// Reads Radiance pictures (.hdr) through stb_image.

#include "import/environment/image_rows.h"

#include <string>

namespace alvor {

/// Passes the pixels of a Radiance picture (32-bit_rle_rgbe) on to `rows`, divided by the exposures that its header states.
/// Throws ImportError.
void read_radiance(const std::string& bytes, ImageRows& rows);

}  // namespace alvor
