#pragma once

#include "import/apart/scene_file.h"
#include "import/base/scene_files.h"

namespace alvor {

/// Reads the default scene of a glTF 2.0 file, text or binary, through tinygltf: triangles, strips and fans. Node transforms are
/// applied. Points and lines are skipped; skins and morph targets stay at rest. The scene is not checked further. Throws
/// ImportError.
SceneFile import_gltf(SceneFiles& files);

}  // namespace alvor
