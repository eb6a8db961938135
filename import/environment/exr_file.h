#pragma once
// Reads OpenEXR images.

#include "import/environment/image_rows.h"

#include <string>

namespace alvor {

/// Passes the pixels of the first part of an OpenEXR image on to `rows`: its channels R, G and B, or Y alone. Needs no threads
/// and opens no file. Throws ImportError, and exceptions of the library.
void read_exr(std::string bytes, ImageRows& rows);

}  // namespace alvor
