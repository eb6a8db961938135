#pragma once

#include "import/scene_file.h"

#include <string_view>

namespace alvor {

/// Reads the default scene of a glTF 2.0 file, text or binary, through tinygltf: triangles, strips and fans. Node transforms are
/// applied. Points and lines are skipped; skins and morph targets stay at rest. The scene is not checked further. Throws
/// ImportError.
SceneFile import_gltf(const std::filesystem::path& path);

/// Reads the bytes of a glTF 2.0 file; files that it names are read from `folder`.
SceneFile import_gltf(std::string_view bytes, const std::filesystem::path& folder);

}  // namespace alvor
