#include "client/command/options/light_options.h"

#include "client/command/options/option_checks.h"

namespace alvor {

void add_light_options(CLI::App& command, LightOptions& options) {
  command.add_option("--light-scale", options.scale, "Multiply the intensity of all lamps and suns, not of emissive faces (1)")
      ->check(CLI::Range(0.0, 1e12));
  command
      .add_option("--quantity", options.quantity,
                  "Unit of the file's light: radiometric (W) or photometric (lm) (photometric for glTF, else radiometric)")
      ->check(CLI::IsMember({"radiometric", "photometric"}));
}

void take_light_options(const LightOptions& options, Scene& scene) {
  for (Light& light : scene.lights) light.intensity *= options.scale;
  if (!options.quantity.empty())
    scene.quantity = options.quantity == "photometric" ? Quantity::photometric : Quantity::radiometric;
}

}  // namespace alvor
