#pragma once
// Line drawings by Cairo.

#include "client/picture/png_file.h"

#include <cairo.h>

#include <memory>

namespace alvor {

using CairoSurface = std::unique_ptr<cairo_surface_t, void (*)(cairo_surface_t*)>;
using CairoContext = std::unique_ptr<cairo_t, void (*)(cairo_t*)>;

/// Returns an empty drawing of so many pixels. Errors show in the status of contexts made of it.
CairoSurface new_drawing(int width, int height);

/// Returns a drawing that shows a picture. Requires: !image.has_opacity.
CairoSurface drawing_of(const Image& image);

/// Returns the picture that a drawing shows.
Image image_of(cairo_surface_t* drawing);

}  // namespace alvor
