#include "client/command/options/light_options.h"

#include "client/command/options/luminaire_option.h"
#include "client/picture/units.h"
#include "proto/codec.h"

#include <utility>

namespace alvor {

void add_file_light_options(CLI::App& command, LightOptions& options) {
  command
      .add_option("--light-scale", options.scale,
                  "Multiply the intensity of the lamps and suns in the scene file, not of emissive faces (1)")
      ->check(CLI::Range(0.0, 1e12));
  command
      .add_option("--quantity", options.quantity,
                  "Unit of the file's light: radiometric (W) or photometric (lm) (photometric for glTF, else radiometric)")
      ->check(CLI::IsMember({name_of(Quantity::radiometric), name_of(Quantity::photometric)}));
}

void add_light_options(CLI::App& command, LightOptions& options) {
  add_file_light_options(command, options);
  command
      .add_option("--luminaire", options.luminaires,
                  "Hang a luminaire: FILE.ies@x,y,z or FILE.ldt@x,y,z:turn,tilt,spin (metres, degrees; down if no angles); "
                  "any number of times")
      ->type_name("FILE@PLACE")
      ->allow_extra_args(false);
  command
      .add_option("--luminous-efficacy", options.efficacy,
                  "Lumens per watt of luminaires, sun and sky in a radiometric scene (179)")
      ->check(CLI::Range(1e-3, 683.0));
  add_sky_options(command, options.sky);
  add_environment_options(command, options.environment);
}

void take_light_options(const LightOptions& options, SceneImport& import) {
  if (options.scale != 1) import.options.set_light_scale(options.scale);
  if (!options.quantity.empty()) import.options.set_quantity(encode(quantity_of(options.quantity)));
  if (options.efficacy) import.options.set_lumens_per_watt(*options.efficacy);
  if (auto daylight = daylight_of(options.sky)) *import.options.mutable_daylight() = *std::move(daylight);
  LightFiles files;
  add_luminaires(options.luminaires, import.options, files);
  take_environment(options.environment, import.options, files);
  import.files = files.take();
}

}  // namespace alvor
