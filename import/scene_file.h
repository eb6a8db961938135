#pragma once
// Reads scene files of all supported formats.

#include "meshing/scene.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace alvor {

struct SceneFile {
  Scene scene;
  std::vector<std::string> warnings;  ///< one sentence each: clamped reflectance, averaged texture, ...
};

/// Thrown where a file is not a valid scene. what() is one line: file, place, reason.
struct SceneFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads a scene: OBJ+MTL through tinyobjloader, glTF 2.0 / GLB through tinygltf, other formats through Assimp. Faces keep the
/// order and the corners of the file. Node transforms are applied; radiance becomes emission (E = pi L). Reflectance of 1 or more
/// is clamped to 0.95 with a warning. The scene has no fault (find_fault). Throws SceneFileError.
SceneFile read_scene_file(const std::filesystem::path& path);

/// A scene that does not come from a file of its own, but for example from a pipe.
struct EncodedScene {
  std::string name;  ///< the scene's name in error messages
  std::string bytes;
  std::string extension;         ///< tells the format, in lower case, like ".glb"
  std::filesystem::path folder;  ///< the folder of the files that the scene names; empty: the working folder
};

/// Reads a scene from bytes as read_scene_file does from a file. Throws SceneFileError. Requires:
/// is_scene_extension(content.extension).
SceneFile read_scene_content(const EncodedScene& content);

/// Returns whether scenes are read from files with this extension, given in lower case with its dot.
bool is_scene_extension(const std::string& extension);

}  // namespace alvor
