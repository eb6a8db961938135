#pragma once

#include "import/scene_file.h"

namespace alvor {

/// Reads what Assimp reads (PLY, STL, 3DS, Collada, FBX, ...), node transforms applied, faces in the order of the nodes and of
/// the file. Points and lines are skipped. The scene is not checked further. Throws ImportError.
SceneFile import_by_assimp(const std::filesystem::path& path);

/// Reads the bytes of a file of which `extension`, like ".stl", tells the format; textures are in `folder`.
SceneFile import_by_assimp(const std::string& bytes, const std::string& extension, const std::filesystem::path& folder);

/// Returns whether files with an extension like ".stl" can be read that way.
bool is_read_by_assimp(const std::string& extension);

}  // namespace alvor
