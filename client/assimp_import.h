#pragma once

#include "client/scene_file.h"

namespace alvor {

/// Reads what Assimp reads (PLY, STL, 3DS, Collada, FBX, ...), node transforms applied, faces in the order of the nodes and of
/// the file. Points and lines are skipped. The scene is not checked further. Throws ImportError.
SceneFile import_by_assimp(const std::filesystem::path& path);

}  // namespace alvor
