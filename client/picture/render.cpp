#include "client/picture/render.h"

#include "client/picture/colouring.h"
#include "client/picture/legend.h"
#include "client/picture/stage.h"
#include "client/picture/tone_map.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace alvor {
namespace {

constexpr double background = 0.018;  ///< linear; dark grey
constexpr double line_strength = 0.6;
constexpr double light_line = 0.35;
/// Triangles lower than this many pixels fade their lines; otherwise the picture would be all lines.
constexpr double crowded_pixels = 5;

/// How a picture shows surfaces.
struct Look {
  std::function<Rgb(const Seen&)> colour;  ///< linear, in [0, 1]
  double dark_below;                       ///< luminance; darker places get light lines, others dark lines
};

/// Returns the exposure for the points that a coarse picture of the view shows.
double exposure_of(const Stage& stage, const Camera& camera) {
  std::vector<LitArea> areas;
  stage.glance(camera, [&](const Seen& seen) {
    const RgbF radiosity = stage.radiosity(seen);
    areas.push_back({luminance(widen(radiosity)), 1, emits(radiosity, stage.irradiance(seen))});
  });
  return automatic_exposure(std::move(areas));
}

/// Shades the samples of one picture.
class Shader {
 public:
  Shader(const Stage& stage, const Camera& camera, Look look, bool wireframe)
      : stage_(stage), view_(camera), look_(std::move(look)), wireframe_(wireframe) {}

  /// Returns the colour at (x, y) of the picture: linear, in [0, 1].
  Rgb shade(double x, double y) const {
    const auto seen = stage_.look(view_.eye(), view_.direction(x, y));
    if (!seen) return {background, background, background};
    const Rgb shown = look_.colour(*seen);
    return wireframe_ ? with_line(shown, line_cover(seen->triangle, x, y)) : shown;
  }

 private:
  /// Returns how much of this place, in [0, 1], is covered by a line about one pixel wide along the outline.
  double line_cover(std::uint32_t triangle, double x, double y) const {
    const auto weight = [&](double px, double py) {
      return stage_.centre_weight(triangle, view_.eye(), view_.direction(px, py));
    };
    const double here = weight(x, y);
    const double per_pixel = std::hypot(weight(x + 1, y) - here, weight(x, y + 1) - here);
    if (!(per_pixel > 0)) return 0;
    const double pixels_off = std::abs(here) / per_pixel, pixels_high = 1 / per_pixel;
    return std::clamp(1.5 - 2 * pixels_off, 0.0, 1.0) * std::min(1.0, pixels_high / crowded_pixels);
  }

  Rgb with_line(const Rgb& shown, double cover) const {
    const double ink = luminance(shown) > look_.dark_below ? 0 : light_line;
    const double share = line_strength * cover;
    return (1 - share) * shown + share * Rgb{ink, ink, ink};
  }

  const Stage& stage_;
  Viewfinder view_;
  Look look_;
  bool wireframe_;
};

Rgb shade_pixel(const Shader& shader, int column, int row, int samples_per_side) {
  Rgb sum;
  for (int i = 0; i < samples_per_side * samples_per_side; ++i) {
    const double x = (i % samples_per_side + 0.5) / samples_per_side, y = (i / samples_per_side + 0.5) / samples_per_side;
    sum += shader.shade(column + x, row + y);
  }
  return sum * (1.0 / (samples_per_side * samples_per_side));
}

Image shade_picture(const Shader& shader, int width, int height, int samples_per_side) {
  Image image{width, height, {}};
  const std::size_t row_size = std::size_t{3} * static_cast<std::size_t>(width);
  image.rgb.resize(row_size * static_cast<std::size_t>(height));
  tbb::parallel_for(0, height, [&](int row) {
    std::uint8_t* out = image.rgb.data() + row_size * static_cast<std::size_t>(row);
    for (int column = 0; column < width; ++column) {
      const Rgb colour = shade_pixel(shader, column, row, samples_per_side);
      for (const double band : {colour.r, colour.g, colour.b}) *out++ = srgb_byte(band);
    }
  });
  return image;
}

Image picture_of(const Stage& stage, const Camera& camera, const RenderOptions& options, Look look) {
  const Shader shader(stage, camera, std::move(look), options.wireframe);
  return shade_picture(shader, camera.width, camera.height, options.samples_per_side);
}

Image lit_picture(const Stage& stage, const Camera& camera, const RenderOptions& options) {
  const double exposure = options.exposure ? *options.exposure : exposure_of(stage, camera);
  const auto colour = [&](const Seen& seen) { return tone_map(exposure * widen(stage.radiosity(seen))); };
  return picture_of(stage, camera, options, {colour, 0.01});
}

Image measured_picture(const Stage& stage, const Camera& camera, const RenderOptions& options) {
  const Colouring colouring(stage, camera, *options.false_colour);
  const auto colour = [&](const Seen& seen) { return colouring.colour(seen); };
  const Image view = picture_of(stage, camera, options, {colour, 0.1});
  if (!options.false_colour->legend) return view;
  const std::vector<std::string> title = legend_title(*options.false_colour, stage.mesh().quantity);
  return with_legend(view, {colouring.scale(), title, colouring.values_below(), colouring.values_above()});
}

}  // namespace

PictureSize view_size(PictureSize picture, const std::optional<FalseColour>& false_colour) {
  const bool legend = false_colour && false_colour->legend;
  return {picture.width - (legend ? legend_width(picture.height) : 0), picture.height};
}

Image render(const DisplayMesh& mesh, const RenderOptions& options) {
  assert(!mesh.triangles.empty() && options.samples_per_side >= 1);
  const Stage stage(mesh);
  const PictureSize size = view_size(options.size, options.false_colour);
  const Camera camera = options.camera ? *options.camera : default_camera(mesh, stage.caster(), size);
  return options.false_colour ? measured_picture(stage, camera, options) : lit_picture(stage, camera, options);
}

Image render(const Stage& stage, const Camera& camera, const std::function<Rgb(const Seen&)>& colour) {
  return picture_of(stage, camera, {}, {colour, 0});
}

double automatic_exposure(const DisplayMesh& mesh, const Camera& camera) { return exposure_of(Stage(mesh), camera); }

}  // namespace alvor
