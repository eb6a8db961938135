#pragma once
// Scene files in.

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

/// A file that is not a scene. what() is one line: file, place, reason.
struct SceneFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Reads OBJ+MTL and what else Assimp reads well, and glTF 2.0 / GLB through tinygltf. Faces keep the order and
/// the corners that they have in the file. Node transforms are applied; radiance becomes emission (E = pi L). Reflectance of 1 or
/// more is clamped to 0.95 with a warning. The scene has no fault (find_fault). Throws SceneFileError.
SceneFile read_scene_file(const std::filesystem::path& path);

/// A scene that comes from elsewhere than a file of its own, such as a pipe.
struct SceneBytes {
  std::string name;  ///< what errors call it
  std::string bytes;
  std::string extension;         ///< tells the format, in lower case: ".glb"
  std::filesystem::path folder;  ///< where the files are that the scene names; empty: the working folder
};

/// Reads what read_scene_file would read from a file of these bytes. Throws SceneFileError. Requires:
/// is_scene_extension(content.extension).
SceneFile read_scene_content(const SceneBytes& content);

/// Returns whether scenes are read from files with this extension, in lower case and with its dot.
bool is_scene_extension(const std::string& extension);

}  // namespace alvor
