#include "client/picture/drawing.h"

#include <cstddef>

namespace alvor {

namespace {

/// Calls visit(pixel, bytes) for the four bytes of each pixel, blue first, from the top left.
template <class Visit>
void for_pixels(cairo_surface_t* drawing, Visit visit) {
  const int width = cairo_image_surface_get_width(drawing), height = cairo_image_surface_get_height(drawing);
  unsigned char* rows = cairo_image_surface_get_data(drawing);
  const std::ptrdiff_t stride = cairo_image_surface_get_stride(drawing);
  std::size_t pixel = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) visit(pixel++, rows + y * stride + std::ptrdiff_t{4} * x);
}

}  // namespace

CairoSurface new_drawing(int width, int height) {
  return {cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), cairo_surface_destroy};
}

CairoSurface drawing_of(const Image& image) {
  CairoSurface drawing = new_drawing(image.width, image.height);
  cairo_surface_flush(drawing.get());
  for_pixels(drawing.get(), [&](std::size_t pixel, unsigned char* bytes) {
    for (std::size_t band = 0; band < 3; ++band) bytes[2 - band] = image.rgb[3 * pixel + band];
  });
  cairo_surface_mark_dirty(drawing.get());
  return drawing;
}

Image image_of(cairo_surface_t* drawing) {
  cairo_surface_flush(drawing);
  Image image{cairo_image_surface_get_width(drawing), cairo_image_surface_get_height(drawing), {}};
  for_pixels(drawing, [&](std::size_t, const unsigned char* bytes) {
    image.rgb.insert(image.rgb.end(), {bytes[2], bytes[1], bytes[0]});
  });
  return image;
}

}  // namespace alvor
