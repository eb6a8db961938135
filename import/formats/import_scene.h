#pragma once
// Reads scene files of all formats from memory, in the calling process. Others use read_scene_file() or run_importer(), which do
// this in a process of its own.

#include "alvor/v1/scene_service.pb.h"
#include "import/apart/scene_file.h"
#include "import/base/scene_files.h"

#include <string>
#include <vector>

namespace alvor {

/// A scene, or the names of the files without which it was not taken.
struct ImportedScene {
  SceneFile file;  ///< empty if files are missing
  std::vector<std::string> missing;
};

/// Reads a scene: OBJ+MTL through tinyobjloader, glTF 2.0 / GLB through tinygltf, other formats through Assimp. Faces keep the
/// order and the corners of the file. Node transforms are applied; radiance becomes emission (E = pi L). Reflectance of 1 or more
/// is clamped to 0.95 with a warning, and so is reflectance with diffuse transmittance. The scene has no fault (find_fault).
/// Throws ImportError.
ImportedScene import_scene(SceneFiles& files, const v1::ImportOptions& options);

}  // namespace alvor
