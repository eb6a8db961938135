#pragma once

#include "import/scene_file.h"

#include <iosfwd>

namespace alvor {

/// Reads OBJ with its MTL files through tinyobjloader. Faces are polygons of any size and come in the order of the `f` lines;
/// coordinates are double (Assimp regroups the faces by object and material, and rounds to float). Points, lines and two-cornered
/// faces are skipped; materials that no face uses are left out. The scene is not checked further. Throws ImportError.
SceneFile import_obj(const std::filesystem::path& path);

/// Reads OBJ from a stream; its MTL files and textures are read from `folder`.
SceneFile import_obj(std::istream& stream, const std::filesystem::path& folder);

}  // namespace alvor
