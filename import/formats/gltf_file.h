#pragma once

#include "import/base/scene_files.h"

namespace alvor_tinygltf {
class Model;
}
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// Parses a glTF 2.0 file, text or binary, with the buffers and images that it names. Images stay encoded, those in buffer views
/// stay there. Numbers and indices are not checked. Throws ImportError, also for required extensions that change shapes in ways
/// not known here, and MissingFileError after asking for all files that are needed.
tinygltf::Model load_gltf(SceneFiles& files);

}  // namespace alvor
