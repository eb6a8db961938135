#include "import/formats/placed_luminaires.h"

#include "import/base/import_error.h"
#include "import/base/scene_format.h"
#include "import/photometry/luminaire_file.h"

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

namespace alvor {

namespace {

constexpr double radians = std::numbers::pi / 180;

/// Returns `v` turned about a unit axis, counter-clockwise seen from the axis's end.
Vec3 turned(Vec3 v, Vec3 axis, double degrees) {
  const double c = std::cos(degrees * radians), s = std::sin(degrees * radians);
  return c * v + s * cross(axis, v) + (1 - c) * dot(axis, v) * axis;
}

/// Returns the light of a luminaire at its place.
Light hang(const LuminaireFile& file, const v1::PlacedLuminaire& place, UpAxis axis) {
  for (const double degrees : {place.turn_degrees(), place.tilt_degrees(), place.spin_degrees()})
    if (!(std::abs(degrees) <= 1e6)) throw ImportError("luminaire '" + place.file() + "'", "an angle is not within 1e6 degrees");
  const Vec3 up = axis == UpAxis::y ? Vec3{0, 1, 0} : Vec3{0, 0, 1}, x{1, 0, 0};
  const auto put = [&](Vec3 v) {
    return turned(turned(turned(v, up, place.spin_degrees()), cross(up, x), -place.tilt_degrees()), up, place.turn_degrees());
  };
  Light light;
  light.kind = LightKind::luminaire;
  light.name = place.file();
  light.intensity = {1, 1, 1};
  light.position = {place.position().x(), place.position().y(), place.position().z()};
  light.direction = normalized(put(-up));
  light.across = put(x);
  light.across = normalized(light.across - dot(light.across, light.direction) * light.direction);
  light.web = file.web;
  light.opening = file.opening;
  light.electrical_watts = file.watts;
  return light;
}

LuminaireFile read(const std::string& name, const std::string& bytes) {
  const std::string extension = lower_case_extension(name);
  if (!is_luminaire_extension(extension)) throw ImportError("luminaire '" + name + "'", "is neither .ies nor .ldt");
  try {
    return read_luminaire(bytes, extension);
  } catch (const ImportError& error) {
    throw ImportError("luminaire '" + name + "'", error.what());
  }
}

std::string told_efficacy(double lumens_per_watt) {
  char told[200];
  std::snprintf(told, sizeof told,
                "the scene is radiometric: a lumen of its luminaires counts as 1/%g W (luminous efficacy); a photometric scene "
                "is in lx",
                lumens_per_watt);
  return told;
}

}  // namespace

void add_luminaires(const v1::ImportOptions& options, double lumens_per_watt, SceneFiles& files, Scene& scene,
                    std::vector<std::string>& warnings) {
  const bool is_radiometric = scene.quantity == Quantity::radiometric;
  std::map<std::string, LuminaireFile> known;
  for (const v1::PlacedLuminaire& place : options.luminaires()) {
    auto file = known.find(place.file());
    if (file == known.end()) {
      const std::string* bytes = files.find(place.file());
      if (!bytes) throw ImportError("luminaire '" + place.file() + "'", "its file is not there, or its name is not allowed");
      file = known.emplace(place.file(), read(place.file(), *bytes)).first;
      for (const std::string& warning : file->second.warnings) warnings.push_back("luminaire '" + place.file() + "': " + warning);
    }
    scene.lights.push_back(hang(file->second, place, scene.up));
    if (is_radiometric) scene.lights.back().intensity *= 1 / lumens_per_watt;
  }
  if (!known.empty() && is_radiometric) warnings.push_back(told_efficacy(lumens_per_watt));
}

}  // namespace alvor
