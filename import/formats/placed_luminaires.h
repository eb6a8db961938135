#pragma once
// Luminaires that are added to a scene.

#include "alvor/v1/scene_service.pb.h"
#include "import/base/scene_files.h"
#include "meshing/scene.h"

#include <string>
#include <vector>

namespace alvor {

/// Appends the luminaires of the options to the scene's lights; their photometric files are among `files`. Luminaires of one file
/// share its web. Throws ImportError that names the file. Requires: the scene has its quantity and its up axis.
void add_luminaires(const v1::ImportOptions& options, double lumens_per_watt, SceneFiles& files, Scene& scene,
                    std::vector<std::string>& warnings);

}  // namespace alvor
