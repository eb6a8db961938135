#pragma once
// Luminaires that the command line adds to a scene.

#include "alvor/v1/scene_service.pb.h"
#include "client/command/options/light_files.h"
#include "import/photometry/luminaire_file.h"

#include <filesystem>
#include <span>
#include <string>

namespace alvor {

/// Appends the luminaires of the command line, each FILE@x,y,z or FILE@x,y,z:turn,tilt,spin, to the options, and
/// their files to `files`. Throws Failure: (usage) for a text that is not like that, (bad_scene) for a
/// file that cannot be read.
void add_luminaires(std::span<const std::string> texts, v1::ImportOptions& options, LightFiles& files);

/// Reads a photometric file. Throws Failure (bad_scene) that names the file, the line and the reason.
LuminaireFile read_luminaire_file(const std::filesystem::path& path);

}  // namespace alvor
