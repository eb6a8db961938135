#include "import/formats/import_scene.h"

#include "import/base/one_line.h"
#include "import/base/scene_format.h"
#include "import/base/unique_names.h"
#include "import/formats/assimp_import.h"
#include "import/formats/daylight.h"
#include "import/formats/gltf_import.h"
#include "import/formats/obj_import.h"
#include "import/formats/placed_environment.h"
#include "import/formats/placed_luminaires.h"
#include "import/formats/see_through.h"
#include "meshing/daylight.h"
#include "proto/codec.h"

#include <algorithm>
#include <cstdio>
#include <new>
#include <span>

namespace alvor {

namespace {

/// A face is a line or a point if twice its area over the square of its outline's length is below this.
constexpr double flat = 1e-14;

SceneFile import_by_extension(SceneFiles& files) {
  if (files.bytes().empty()) throw ImportError("file", "is empty");
  const std::string extension = lower_case_extension(files.scene());
  if (extension == ".obj") return import_obj(files);
  if (extension == ".gltf" || extension == ".glb") return import_gltf(files);
  return import_by_assimp(files);
}

void take_options(const v1::ImportOptions& options, Scene& scene) {
  if (options.has_light_scale())
    for (Light& light : scene.lights) light.intensity *= options.light_scale();
  if (options.has_absorption_per_meter()) scene.absorption = decode(options.absorption_per_meter());
  decode(options.quantity(), scene.quantity);
  decode(options.up_axis(), scene.up);
  scene.north_degrees = options.daylight().north_degrees();
}

/// Adds the lights that the options tell, after the scene has its quantity and its up axis.
void add_lights(const v1::ImportOptions& options, SceneFiles& files, SceneFile& file) {
  const double lumens_per_watt = options.has_lumens_per_watt() ? options.lumens_per_watt() : usual_lumens_per_watt;
  if (!(lumens_per_watt >= 1e-3 && lumens_per_watt <= 683)) throw ImportError("lumens per watt", "is outside [0.001, 683]");
  // Luminaires that the scene file itself names are in cd, as their photometric files are.
  if (file.scene.quantity == Quantity::radiometric)
    for (Light& light : file.scene.lights)
      if (light.kind == LightKind::luminaire) light.intensity *= 1 / lumens_per_watt;
  if (options.has_daylight()) add_daylight(options.daylight(), lumens_per_watt, file.scene, file.warnings);
  add_luminaires(options, lumens_per_watt, files, file.scene, file.warnings);
  if (options.has_environment()) add_environment(options, files, file.scene, file.warnings);
}

/// Returns a band of reflectance clamped to [0, 1). NaN stays as it is and is a fault.
double clamped(double reflectance) {
  if (reflectance < 0) return 0;
  return reflectance >= 1 ? clamped_reflectance : reflectance;
}

std::string text_of(const Rgb& bands) {
  char text[96];
  std::snprintf(text, sizeof text, "%g %g %g", bands.r, bands.g, bands.b);
  return text;
}

/// Scales what a translucent material scatters to both sides below 1 in all bands. NaN stays as it is and is a fault.
void clamp_albedo(Material& material, std::vector<std::string>& warnings) {
  if (!material.diffuse_transmittance.is_finite()) return;
  material.diffuse_transmittance = upper(material.diffuse_transmittance, {});
  if (!material.is_translucent()) return;
  const Rgb albedo = upper(material.largest_albedo(), material.reflectance + material.diffuse_transmittance);
  if (albedo.is_finite() && albedo.max() >= 1) {
    scale_albedo(material, clamped_reflectance / albedo.max());
    warnings.push_back("material '" + material.name + "': reflectance and diffuse transmittance, together " + text_of(albedo) +
                       ", are scaled to " + text_of(clamped_reflectance / albedo.max() * albedo));
  }
  const Rgb rest = Rgb{1, 1, 1} - upper(material.largest_albedo(), material.reflectance + material.diffuse_transmittance);
  material.regular_transmittance = upper(lower(material.regular_transmittance, rest), {});
}

void clamp_reflectance(SceneFile& file) {
  for (Material& material : file.scene.materials) {
    const Rgb given = material.reflectance;
    if (!given.is_finite()) continue;
    material.reflectance = {clamped(given.r), clamped(given.g), clamped(given.b)};
    material.regular_transmittance = upper(lower(material.regular_transmittance, Rgb{1, 1, 1} - material.reflectance), Rgb{});
    if (material.reflectance != given)
      file.warnings.push_back("material '" + material.name + "': reflectance " + text_of(given) + " is clamped to " +
                              text_of(material.reflectance));
    clamp_albedo(material, file.warnings);
  }
}

/// Returns the first names for an error message, in quotes.
std::string first_names(std::span<const Material> materials) {
  if (materials.empty()) return "none";
  constexpr std::size_t most = 8;
  std::string text;
  for (const Material& material : materials.first(std::min(most, materials.size())))
    text += (text.empty() ? "'" : ", '") + material.name + "'";
  return materials.size() > most ? text + " and " + std::to_string(materials.size() - most) + " more" : text;
}

/// Makes the materials translucent that the options name. Requires: materials have different names.
void take_translucent(const v1::ImportOptions& options, Scene& scene) {
  for (const v1::TranslucentMaterial& wanted : options.translucent()) {
    const std::string place = "translucent material '" + wanted.material() + "'";
    const Rgb transmittance = decode(wanted.diffuse_transmittance());
    for (const double band : {transmittance.r, transmittance.g, transmittance.b})
      if (!(band >= 0 && band <= 1))
        throw ImportError(place, "its diffuse transmittance " + text_of(transmittance) + " is outside [0, 1]");
    const auto found = std::ranges::find(scene.materials, wanted.material(), &Material::name);
    if (found == scene.materials.end())
      throw ImportError(place, "is not in the scene, which has " + first_names(scene.materials));
    make_translucent(*found, transmittance);
  }
}

bool has_area(const Scene& scene, const Face& face) {
  const auto corners = scene.corners_of(face);
  const Vec3 start = scene.vertices[corners[0]];
  Vec3 double_area;
  double outline = 0;
  for (std::size_t c = 1; c < corners.size(); ++c) {
    const Vec3 from = scene.vertices[corners[c - 1]] - start, to = scene.vertices[corners[c]] - start;
    double_area += cross(from, to);
    outline += length(to - from);
  }
  return length(double_area) > flat * outline * outline;
}

void refuse_faulty(const Scene& scene) {
  if (const auto fault = find_fault(scene)) throw ImportError(fault->place, fault->reason);
  if (std::ranges::none_of(scene.faces, [&](const Face& face) { return has_area(scene, face); }))
    throw ImportError("scene", "all " + std::to_string(scene.faces.size()) + " faces are degenerate");
}

void make_names_unique(Scene& scene) {
  const auto of = [](auto& list, const char* otherwise) {
    std::vector<std::string*> names;
    for (auto& item : list) names.push_back(&item.name);
    make_unique(names, otherwise);
  };
  of(scene.materials, "material");
  of(scene.lights, "light");
  of(scene.objects, "object");
}

/// Gives all corners a texture point if any has, or if any material has a texture.
void complete_texture_points(Scene& scene) {
  const auto has_texture = [](const Material& material) { return material.texture.has_value(); };
  const bool are_needed = std::ranges::any_of(scene.materials, has_texture);
  scene.texture_points.resize(are_needed ? scene.corners.size() : 0);
}

SceneFile checked(SceneFile file, const v1::ImportOptions& options) {
  complete_texture_points(file.scene);
  make_names_unique(file.scene);
  take_translucent(options, file.scene);
  clamp_reflectance(file);
  refuse_faulty(file.scene);
  for (std::string& warning : file.warnings) warning = one_line_of(warning);
  return file;
}

ImportedScene imported(SceneFiles& files, const v1::ImportOptions& options) {
  for (const std::string& name : options.absent_files()) files.declare_absent(name);
  try {
    SceneFile file = import_by_extension(files);
    for (const v1::PlacedLuminaire& luminaire : options.luminaires()) files.find(luminaire.file());
    if (options.has_environment()) files.find(options.environment().file());
    files.require_found();
    take_options(options, file.scene);
    add_lights(options, files, file);
    return {checked(std::move(file), options), {}};
  } catch (const MissingFileError&) {
    if (files.missing().empty()) throw;  // it is absent
    return {{}, {files.missing().begin(), files.missing().end()}};
  }
}

}  // namespace

ImportedScene import_scene(SceneFiles& files, const v1::ImportOptions& options) {
  try {
    return imported(files, options);
  } catch (const ImportError& error) {
    throw ImportError(one_line_of(error.what()));
  } catch (const std::bad_alloc&) {
    throw ImportError("file", "needs too much memory");
  } catch (const std::exception& error) {  // thrown by the libraries
    throw ImportError("file", one_line_of(error.what()));
  }
}

}  // namespace alvor
