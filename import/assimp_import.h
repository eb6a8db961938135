#pragma once

#include "import/scene_file.h"

namespace alvor {

/// Reads the formats that Assimp reads (PLY, STL, 3DS, Collada, FBX, ...). Node transforms are applied; faces come in the order
/// of the nodes and of the file. Points and lines are skipped. The scene is not checked further. Throws ImportError.
SceneFile import_by_assimp(const std::filesystem::path& path);

/// Reads a file from its bytes. `extension`, like ".stl", tells the format; textures are read from `folder`.
SceneFile import_by_assimp(const std::string& bytes, const std::string& extension, const std::filesystem::path& folder);

/// Returns whether Assimp reads files with this extension, like ".stl".
bool is_read_by_assimp(const std::string& extension);

}  // namespace alvor
