#pragma once

#include "import/apart/scene_file.h"
#include "import/base/scene_files.h"

namespace alvor {

/// Reads the formats that Assimp reads (PLY, STL, 3DS, Collada, FBX, ...). Node transforms are applied; faces come in the order
/// of the nodes and of the file. Points and lines are skipped. The scene is not checked further. Throws ImportError.
SceneFile import_by_assimp(SceneFiles& files);

}  // namespace alvor
