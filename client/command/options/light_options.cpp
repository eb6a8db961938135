#include "client/command/options/light_options.h"

#include "client/command/options/luminaire_option.h"
#include "client/picture/units.h"

#include <cstdio>
#include <map>
#include <utility>

namespace alvor {

void add_light_options(CLI::App& command, LightOptions& options) {
  command.add_option("--light-scale", options.scale, "Multiply the intensity of all lamps and suns, not of emissive faces (1)")
      ->check(CLI::Range(0.0, 1e12));
  command
      .add_option("--quantity", options.quantity,
                  "Unit of the file's light: radiometric (W) or photometric (lm) (photometric for glTF, else radiometric)")
      ->check(CLI::IsMember({name_of(Quantity::radiometric), name_of(Quantity::photometric)}));
  command
      .add_option("--luminaire", options.luminaires,
                  "Hang a luminaire: FILE.ies@x,y,z or FILE.ldt@x,y,z:turn,tilt,spin (metres, degrees; down if no angles); "
                  "any number of times")
      ->type_name("FILE@PLACE")
      ->expected(1)
      ->take_all();
  command
      .add_option("--luminous-efficacy", options.efficacy,
                  "Lumens per watt of luminaires, sun and sky in a radiometric scene (179)")
      ->check(CLI::Range(1e-3, 683.0));
  add_sky_options(command, options.sky);
}

void take_light_options(const LightOptions& options, SceneFile& file) {
  Scene& scene = file.scene;
  for (Light& light : scene.lights) light.intensity *= options.scale;
  if (!options.quantity.empty()) scene.quantity = quantity_of(options.quantity);
  take_sky_options(options.sky, options.efficacy, scene, file.warnings);
  std::map<std::filesystem::path, LuminaireFile> luminaires;
  for (const std::string& text : options.luminaires) {
    const LuminairePlace place = parse_luminaire_place(text);
    const auto known = luminaires.find(place.file);
    const LuminaireFile& luminaire =
        known != luminaires.end() ? known->second : luminaires.emplace(place.file, read_luminaire_file(place.file)).first->second;
    if (known == luminaires.end())
      for (const std::string& warning : luminaire.warnings) file.warnings.push_back(place.file.string() + ": " + warning);
    scene.lights.push_back(hang(luminaire, place, scene.up));
    if (scene.quantity == Quantity::radiometric) scene.lights.back().intensity *= 1 / options.efficacy;
  }
  if (luminaires.empty() || scene.quantity == Quantity::photometric) return;
  char told[200];
  std::snprintf(told, sizeof told,
                "the scene is radiometric: a lumen of its luminaires counts as 1/%g W (--luminous-efficacy); "
                "--quantity photometric computes in lx",
                options.efficacy);
  file.warnings.push_back(told);
}

}  // namespace alvor
