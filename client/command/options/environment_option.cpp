#include "client/command/options/environment_option.h"

#include "client/command/output/failure.h"
#include "import/base/scene_format.h"

namespace alvor {

void add_environment_options(CLI::App& command, EnvironmentOptions& options) {
  command
      .add_option("--environment", options.file,
                  "Light the scene by an image of its surroundings: FILE.hdr or FILE.exr, equirectangular, its middle along x")
      ->type_name("FILE");
  command
      .add_option("--environment-scale", options.scale,
                  "Multiply the image's values, which then are radiance, W/m2 sr or cd/m2 (1)")
      ->check(CLI::Range(0.0, 1e6));
  command
      .add_option("--environment-turn", options.turn,
                  "Turn the image about the vertical, degrees, counter-clockwise seen from above (0)")
      ->check(CLI::Range(-360.0, 360.0));
}

void take_environment(const EnvironmentOptions& options, v1::ImportOptions& import, LightFiles& files) {
  if (options.file.empty()) {
    if (options.scale || options.turn)
      throw Failure(ExitStatus::usage, "--environment-scale and --environment-turn need --environment");
    return;
  }
  if (!is_environment_extension(lower_case_extension(options.file)))
    throw Failure(ExitStatus::usage, options.file + ": environment maps end in .hdr or .exr");
  v1::PlacedEnvironment& environment = *import.mutable_environment();
  environment.set_file(files.add(options.file, "environment"));
  if (options.scale) environment.set_scale(*options.scale);
  if (options.turn) environment.set_turn_degrees(*options.turn);
}

}  // namespace alvor
