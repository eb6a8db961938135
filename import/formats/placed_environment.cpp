#include "import/formats/placed_environment.h"

#include "import/base/import_error.h"
#include "import/base/scene_format.h"
#include "import/environment/bright_spots.h"
#include "import/environment/environment_file.h"

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

namespace alvor {

namespace {

constexpr double degrees = std::numbers::pi / 180, max_scale = 1e6;

EnvironmentFile read(const v1::PlacedEnvironment& wanted, SceneFiles& files) {
  if (!(std::abs(wanted.turn_degrees()) <= 1e6)) throw ImportError("turn", "is not within 1e6 degrees");
  if (!(wanted.scale() >= 0 && wanted.scale() <= max_scale)) throw ImportError("scale", "is outside [0, 1e6]");
  const std::string extension = lower_case_extension(wanted.file());
  if (!is_environment_extension(extension)) throw ImportError("name", "ends in neither .hdr nor .exr");
  const std::string* bytes = files.find(wanted.file());
  if (!bytes) throw ImportError("file", "is not there, or its name is not allowed");
  return read_environment(*bytes, extension);
}

/// Returns an environment without a map that stands as it is wanted. Its middle looks along x, as in Blender and three.js.
Light stand(const v1::PlacedEnvironment& wanted, UpAxis axis) {
  const Vec3 up = axis == UpAxis::y ? Vec3{0, 1, 0} : Vec3{0, 0, 1}, x{1, 0, 0};
  const double turn = wanted.turn_degrees() * degrees, scale = wanted.has_scale() ? wanted.scale() : 1;
  Light light;
  light.kind = LightKind::environment;
  light.name = wanted.file();
  light.intensity = {scale, scale, scale};
  light.direction = -up;
  light.across = std::cos(turn) * x + std::sin(turn) * cross(up, x);
  return light;
}

Light light_of(const BrightSpot& spot, const Light& environment) {
  Light light;
  light.kind = LightKind::directional;
  light.name = environment.name + ", bright spot";
  light.intensity = environment.intensity * spot.irradiance;
  light.direction = -normalized(EnvironmentAxes(environment).to_scene(spot.towards));
  light.angular_diameter = spot.angular_diameter;
  return light;
}

std::string told(const Light& spot, Vec3 up, Quantity quantity) {
  char text[160];
  std::snprintf(text, sizeof text,
                "its bright spot %.1f degrees above the horizon, %.2f degrees wide, is a distant light of %.4g %s",  //
                std::asin(std::clamp(-dot(spot.direction, up), -1.0, 1.0)) / degrees, spot.angular_diameter / degrees,
                spot.intensity.mean(), quantity == Quantity::photometric ? "lx" : "W/m2");
  return text;
}

}  // namespace

void add_environment(const v1::ImportOptions& options, SceneFiles& files, Scene& scene, std::vector<std::string>& warnings) {
  const v1::PlacedEnvironment& wanted = options.environment();
  const std::string place = "environment '" + wanted.file() + "'";
  try {
    EnvironmentFile file = read(wanted, files);
    for (const std::string& warning : file.warnings) warnings.push_back(place + ": " + warning);
    Light environment = stand(wanted, scene.up);
    for (const BrightSpot& spot : take_bright_spots(file.map)) {
      scene.lights.push_back(light_of(spot, environment));
      warnings.push_back(place + ": " + told(scene.lights.back(), -environment.direction, scene.quantity));
    }
    environment.environment =
        std::make_shared<const EnvironmentMap>(reduced(file.map, EnvironmentMap::most_columns, EnvironmentMap::most_rows));
    if (!environment.environment->total().is_zero()) scene.lights.push_back(std::move(environment));
  } catch (const MissingFileError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw ImportError(place, "needs too much memory");
  } catch (const std::exception& error) {  // also those of OpenEXR
    throw ImportError(place, error.what());
  }
}

}  // namespace alvor
