#pragma once
// Options for how a scene is read by commands that solve it themselves: its light, medium, translucent materials and up axis.

#include "client/command/options/input_file.h"
#include "client/command/options/light_options.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace alvor {

struct SceneOptions {
  std::string absorption;  ///< three numbers; empty: none
  LightOptions light;
  std::vector<std::string> translucent;  ///< MATERIAL=T
  std::string up;                        ///< "y" or "z"; empty: as the file says
};

void add_scene_options(CLI::App& command, SceneOptions& options);

/// Reads a scene, which messages call `name`, and prints its warnings. Throws Failure and SceneFileError.
Scene read_scene(const SceneOptions& options, const RawScene& bytes, const std::string& name);

}  // namespace alvor
