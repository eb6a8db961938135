#pragma once
// Options for what a scene file says about light.

#include "meshing/scene.h"

#include <CLI/CLI.hpp>

#include <string>

namespace alvor {

struct LightOptions {
  double scale = 1;      ///< of all lights that are not faces
  std::string quantity;  ///< "radiometric" or "photometric"; empty: what the format says
};

void add_light_options(CLI::App& command, LightOptions& options);

/// Changes the scene as the options say.
void take_light_options(const LightOptions& options, Scene& scene);

}  // namespace alvor
