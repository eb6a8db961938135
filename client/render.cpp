#include "client/render.h"

#include "client/tone_map.h"
#include "radiosity/visibility.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace alvor {
namespace {

constexpr double background = 0.018;  ///< linear; dark grey
constexpr double line_strength = 0.6;
constexpr double dark_below = 0.01;  ///< luminance; darker places get a light line
constexpr double light_line = 0.35;
constexpr double crowded_pixels = 5;  ///< triangles lower than this fade their lines, or the picture would be all lines

constexpr double float_step = 4e-6;  ///< of a distance: enough to leave a surface for certain in float32

/// An upper bound of the distance between two vertices, at most twice as large.
double extent_of(const DisplayMesh& mesh) {
  double radius = 0;
  for (const Vec3& p : mesh.positions) radius = std::max(radius, length(p - mesh.positions.front()));
  return 2 * radius;
}

/// A point of the front of a surface.
struct Seen {
  std::uint32_t triangle = 0;
  double u = 0, v = 0;
};

/// The mesh made ready for rays.
class Stage {
 public:
  explicit Stage(const DisplayMesh& mesh) : mesh_(mesh), caster_(mesh.positions, mesh.triangles), extent_(extent_of(mesh)) {}
  const TriangleCaster& caster() const { return caster_; }

  /// The first front along a ray. Backs are looked through, so that a closed room can be seen from outside.
  std::optional<Seen> look(Vec3 origin, Vec3 direction) const {
    constexpr int most_backs = 64;
    for (int backs = 0; backs < most_backs; ++backs) {
      const auto hit = caster_.cast(origin, direction);
      if (!hit) return std::nullopt;
      if (dot(area_vector(hit->triangle), direction) < 0) return Seen{hit->triangle, hit->u, hit->v};
      origin += direction * (hit->distance * (1 + float_step) + float_step * extent_);
    }
    return std::nullopt;
  }

  RgbF radiosity(const Seen& seen) const { return interpolated(mesh_.radiosity, seen); }
  RgbF irradiance(const Seen& seen) const { return interpolated(mesh_.irradiance, seen); }

  /// Weight of the first vertex where the ray meets the plane of `triangle`: 0 on the leaf's outline, 1 at its centre.
  double centre_weight(std::uint32_t triangle, Vec3 origin, Vec3 direction) const {
    const Vec3 a = corner(triangle, 0), b = corner(triangle, 1), c = corner(triangle, 2);
    const Vec3 normal = area_vector(triangle);
    const Vec3 point = origin + direction * (dot(b - origin, normal) / dot(direction, normal));
    return dot(cross(b - point, c - point), normal) / dot(cross(b - a, c - a), normal);
  }

 private:
  Vec3 corner(std::uint32_t triangle, int k) const { return mesh_.positions[mesh_.triangles[triangle][k]]; }
  Vec3 area_vector(std::uint32_t triangle) const {
    const Vec3 a = corner(triangle, 0);
    return cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
  }
  RgbF interpolated(const std::vector<RgbF>& values, const Seen& seen) const {
    const auto [a, b, c] = mesh_.triangles[seen.triangle];
    const auto u = static_cast<float>(seen.u), v = static_cast<float>(seen.v);
    return (1 - u - v) * values[a] + u * values[b] + v * values[c];
  }

  const DisplayMesh& mesh_;
  TriangleCaster caster_;
  double extent_;
};

/// Exposure by what a coarse picture sees; the same for every size of the picture.
double exposure_of(const Stage& stage, const Camera& camera) {
  constexpr int columns = 96, rows = 72;
  const Viewfinder view(camera);
  std::vector<LitArea> areas;
  for (int i = 0; i < columns * rows; ++i) {
    const double x = (i % columns + 0.5) / columns * camera.width, y = (i / columns + 0.5) / rows * camera.height;
    const auto seen = stage.look(view.eye(), view.direction(x, y));
    if (!seen) continue;
    const RgbF radiosity = stage.radiosity(*seen);
    areas.push_back({luminance(widen(radiosity)), 1, emits(radiosity, stage.irradiance(*seen))});
  }
  return automatic_exposure(std::move(areas));
}

/// Shades the samples of one picture.
class Shader {
 public:
  Shader(const Stage& stage, const Camera& camera, double exposure, bool wireframe)
      : stage_(stage), view_(camera), exposure_(exposure), wireframe_(wireframe) {}

  /// Linear, in [0, 1], of the place (x, y) of the picture.
  Rgb shade(double x, double y) const {
    const Vec3 direction = view_.direction(x, y);
    const auto seen = stage_.look(view_.eye(), direction);
    if (!seen) return {background, background, background};
    const Rgb shown = tone_map(exposure_ * widen(stage_.radiosity(*seen)));
    return wireframe_ ? with_line(shown, line_cover(seen->triangle, x, y)) : shown;
  }

 private:
  /// How much of a line about a pixel wide, half of it on either side of the outline, covers this place.
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

  /// Dark lines on bright surfaces and light ones on dark.
  static Rgb with_line(const Rgb& shown, double cover) {
    const double ink = luminance(shown) > dark_below ? 0 : light_line;
    const double share = line_strength * cover;
    return (1 - share) * shown + share * Rgb{ink, ink, ink};
  }

  const Stage& stage_;
  Viewfinder view_;
  double exposure_;
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

}  // namespace

Image render(const DisplayMesh& mesh, const RenderOptions& options) {
  assert(!mesh.triangles.empty() && options.samples_per_side >= 1);
  const Stage stage(mesh);
  const Camera camera = options.camera ? *options.camera : default_camera(mesh, stage.caster(), options.size);
  const double exposure = options.exposure ? *options.exposure : exposure_of(stage, camera);
  const Shader shader(stage, camera, exposure, options.wireframe);
  return shade_picture(shader, camera.width, camera.height, options.samples_per_side);
}

double automatic_exposure(const DisplayMesh& mesh, const Camera& camera) { return exposure_of(Stage(mesh), camera); }

}  // namespace alvor
