#include "client/command/options/light_options.h"

#include "client/picture/units.h"

namespace alvor {

void add_light_options(CLI::App& command, LightOptions& options) {
  command.add_option("--light-scale", options.scale, "Multiply the intensity of all lamps and suns, not of emissive faces (1)")
      ->check(CLI::Range(0.0, 1e12));
  command
      .add_option("--quantity", options.quantity,
                  "Unit of the file's light: radiometric (W) or photometric (lm) (photometric for glTF, else radiometric)")
      ->check(CLI::IsMember({name_of(Quantity::radiometric), name_of(Quantity::photometric)}));
}

void take_light_options(const LightOptions& options, Scene& scene) {
  for (Light& light : scene.lights) light.intensity *= options.scale;
  if (!options.quantity.empty()) scene.quantity = quantity_of(options.quantity);
}

}  // namespace alvor
