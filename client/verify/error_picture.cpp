#include "client/verify/error_picture.h"

#include "client/picture/legend.h"
#include "client/picture/render.h"
#include "client/picture/round_number.h"
#include "client/picture/stage.h"
#include "client/verify/error_field.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace alvor {

namespace {

constexpr double percent = 100;
constexpr double dot_angle = 0.0025;  ///< radius of a point's dot as seen from the camera, radians
constexpr double dot_strength = 0.45;

/// Returns a scale symmetric about 0, so that 0 is white. Its ends enclose the errors of nine tenths of the points.
ColourScale scale_of(const ErrorField& field, const Verification& verification) {
  std::vector<double> sizes;
  for (const VerifiedPoint& point : verification.points)
    if (point.standing == Standing::counts)
      sizes.push_back(percent * std::abs(field.at(point.at.position, point.at.normal).error));
  const auto most = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 9 / 10);
  std::ranges::nth_element(sizes, most);
  const double end = *most > 0 ? RoundNumber::at_least(*most).value() : 1;
  return {-end, end, false};
}

/// Returns a factor of brightness by which edges show where the error is the same on both sides. It does not change the hue.
double shade(Vec3 normal) {
  const Vec3 light = normalized({0.35, 0.85, 0.5});
  return 0.72 + 0.28 * std::abs(dot(normal, light));
}

Rgb colour_of(const ErrorField::Value& value, const ColourScale& scale, double from_eye) {
  const Rgb colour = diverging_colour_map(scale.position(percent * value.error));
  return value.distance < dot_angle * from_eye ? (1 - dot_strength) * colour : colour;
}

}  // namespace

Image error_picture(const DisplayMesh& solution, const Verification& verification, PictureSize size) {
  const Stage stage(solution);
  const PictureSize view{size.width - legend_width(size.height), size.height};
  const Camera camera = default_camera(solution, stage.caster(), view);
  std::optional<ErrorField> field;
  if (verification.errors.points > 0) field.emplace(verification);
  const ColourScale scale = field ? scale_of(*field, verification) : ColourScale{-1, 1, false};
  const auto colour = [&](const Seen& seen) {
    const Vec3 normal = stage.normal(seen), place = stage.place(seen);
    if (!field) return shade(normal) * diverging_colour_map(0.5);
    return shade(normal) * colour_of(field->at(place, normal), scale, length(place - camera.eye));
  };
  return with_legend(render(stage, camera, colour), {scale, {"error", "%"}, true, true, diverging_colour_map});
}

}  // namespace alvor
