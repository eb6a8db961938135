#include "client/command/options/luminaire_option.h"

#include "client/command/output/failure.h"
#include "client/command/output/numbers.h"
#include "import/import_error.h"
#include "import/scene_format.h"
#include "import/whole_file.h"

#include <cmath>
#include <numbers>

namespace alvor {

namespace {

constexpr double radians = std::numbers::pi / 180;

/// Returns `v` turned about a unit axis, counter-clockwise seen from the axis's end.
Vec3 turned(Vec3 v, Vec3 axis, double degrees) {
  const double c = std::cos(degrees * radians), s = std::sin(degrees * radians);
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

}  // namespace

LuminairePlace parse_luminaire_place(const std::string& text) {
  const auto at = text.rfind('@');
  if (at != text.npos && at > 0) {
    const std::string rest = text.substr(at + 1);
    const auto colon = rest.find(':');
    const auto place = parse_numbers(rest.substr(0, colon), 3);
    const auto angles = parse_numbers(colon == rest.npos ? "0,0,0" : rest.substr(colon + 1), 3);
    if (place && angles)
      return {text.substr(0, at), {(*place)[0], (*place)[1], (*place)[2]}, (*angles)[0], (*angles)[1], (*angles)[2]};
  }
  throw Failure(ExitStatus::usage, "--luminaire: '" + text + "' is not FILE@x,y,z or FILE@x,y,z:turn,tilt,spin");
}

LuminaireFile read_luminaire_file(const std::filesystem::path& path) {
  const std::string extension = lower_case_extension(path);
  if (!is_luminaire_extension(extension))
    throw Failure(ExitStatus::usage, path.string() + ": photometric files end in .ies or .ldt");
  try {
    return read_luminaire(read_whole_file(path), extension);
  } catch (const ImportError& error) {
    throw Failure(ExitStatus::bad_scene, path.string() + ": " + error.what());
  } catch (const FileError& error) {
    throw Failure(ExitStatus::bad_scene, error.what());
  }
}

Light hang(const LuminaireFile& file, const LuminairePlace& place, UpAxis axis) {
  const Vec3 up = axis == UpAxis::y ? Vec3{0, 1, 0} : Vec3{0, 0, 1}, x{1, 0, 0};
  const auto put = [&](Vec3 v) { return turned(turned(turned(v, up, place.spin), cross(up, x), -place.tilt), up, place.turn); };
  Light light;
  light.kind = LightKind::luminaire;
  light.name = place.file.filename().string();
  light.intensity = {1, 1, 1};
  light.position = place.position;
  light.direction = normalized(put(-up));
  light.across = put(x);
  light.across = normalized(light.across - dot(light.across, light.direction) * light.direction);
  light.web = file.web;
  light.opening = file.opening;
  return light;
}

}  // namespace alvor
