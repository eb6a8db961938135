#pragma once
// An environment map that the command line adds to a scene.

#include "alvor/v1/scene_service.pb.h"
#include "client/command/options/light_files.h"

#include <CLI/CLI.hpp>

#include <optional>
#include <string>

namespace alvor {

struct EnvironmentOptions {
  std::string file;             ///< .hdr or .exr
  std::optional<double> scale;  ///< radiance per value of the file
  std::optional<double> turn;   ///< degrees, counter-clockwise seen from above
};

void add_environment_options(CLI::App& command, EnvironmentOptions& options);

/// Sets the environment of `import`, if the options name one, and adds its file. Throws Failure for options that do not fit
/// together and a file that cannot be read.
void take_environment(const EnvironmentOptions& options, v1::ImportOptions& import, LightFiles& files);

}  // namespace alvor
