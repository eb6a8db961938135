#pragma once
// Options for what a scene file says about light, and for light that is added to it.

#include "client/command/options/environment_option.h"
#include "client/command/options/sky_options.h"
#include "import/apart/scene_file.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>
#include <vector>

namespace alvor {

struct LightOptions {
  double scale = 1;                     ///< of the file's lights that are not faces
  std::string quantity;                 ///< "radiometric" or "photometric"; empty: what the format says
  std::vector<std::string> luminaires;  ///< FILE@x,y,z[:turn,tilt,spin]
  std::optional<double> efficacy;       ///< lm/W of luminaires, sun and sky in a radiometric scene
  SkyOptions sky;
  EnvironmentOptions environment;
};

/// Adds --light-scale and --quantity, for what a file itself says about light.
void add_file_light_options(CLI::App& command, LightOptions& options);
/// Adds --light-scale, --quantity, and the options for light that is added to a scene.
void add_light_options(CLI::App& command, LightOptions& options);

/// Sets what the options say about how a scene is read. Throws Failure for options that do not fit together and files of
/// lights that cannot be read.
void take_light_options(const LightOptions& options, SceneImport& import);

}  // namespace alvor
