#pragma once
// Environment maps that are added to a scene.

#include "alvor/v1/scene_service.pb.h"
#include "import/base/scene_files.h"
#include "meshing/scene.h"

#include <string>
#include <vector>

namespace alvor {

/// Appends the environment of the options to the scene's lights, whose file is among `files`: its bright spots as distant lights,
/// the rest as an environment. Throws ImportError that names the file. Requires: options.has_environment(); the scene has its up
/// axis.
void add_environment(const v1::ImportOptions& options, SceneFiles& files, Scene& scene, std::vector<std::string>& warnings);

}  // namespace alvor
