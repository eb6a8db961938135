#pragma once
// Reads scene files of all supported formats from the disk.

#include "alvor/v1/scene_service.pb.h"
#include "meshing/scene.h"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
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

/// How a scene is read.
struct SceneImport {
  v1::ImportOptions options;                 ///< its scene_file is ignored
  std::map<std::string, std::string> files;  ///< those of the options' lights: the bytes by name
};

/// Reads a scene with the files that it names, from its folder and below. They are read by the program alvor-import, in a process
/// of its own; see import_scene for what is read how. Files that are not there count as missing. Throws SceneFileError, and
/// ImporterError if the program cannot be started.
SceneFile read_scene_file(const std::filesystem::path& path, const SceneImport& import = {});

/// A scene that does not come from a file of its own, but for example from a pipe.
struct EncodedScene {
  std::string name;  ///< the scene's name in error messages
  std::string bytes;
  std::string extension;         ///< tells the format, in lower case, like ".glb"
  std::filesystem::path folder;  ///< the folder of the files that the scene names; empty: the working folder
};

/// Reads a scene from bytes as read_scene_file does from a file.
SceneFile read_scene_content(const EncodedScene& content, const SceneImport& import = {});

/// Returns the bytes of a scene file. Throws SceneFileError.
std::string read_scene_bytes(const std::filesystem::path& path);

/// Returns the bytes of a file that a scene in `folder` names; nothing if its name is not allowed or it cannot be read.
std::optional<std::string> read_beside(const std::filesystem::path& folder, const std::string& name);

/// Returns whether scenes are read from files with this extension, given in lower case with its dot.
bool is_scene_extension(const std::string& extension);
/// Returns all such extensions.
std::span<const std::string_view> scene_extensions();

}  // namespace alvor
