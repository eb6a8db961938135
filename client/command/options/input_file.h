#pragma once
// The input files of a command, one of which may come from stdin.

#include "client/verify/probe.h"
#include "import/apart/scene_file.h"
#include "meshing/display_mesh.h"

#include <CLI/CLI.hpp>

#include <filesystem>
#include <initializer_list>
#include <string>
#include <vector>

namespace alvor {

enum class InputKind { scene, solution, points };

struct InputFile {
  InputKind kind;
  std::filesystem::path path;  ///< "-": stdin
};

/// Adds `--format`, the format of a scene or solution from stdin, written as a suffix: "glb".
void add_format_option(CLI::App& command, std::string& format);

/// Throws Failure (usage) unless the inputs of a command fit together: at most one is stdin, and `format` is given and known
/// exactly if that one is a scene or a solution.
void require_inputs(std::initializer_list<InputFile> inputs, const std::string& format);

// For the functions below: `format` is the format of stdin. Requires: require_inputs has returned.

/// Reads a scene. Files that a scene from stdin names are read from the working folder. Throws SceneFileError, and Failure
/// (bad_scene) if stdin cannot be read.
SceneFile read_scene(const std::filesystem::path& path, const std::string& format, const SceneImport& import = {});

/// A scene file as it is, to be sent to a server.
struct RawScene {
  std::string file;  ///< a name for the server, with the extension of the format
  std::string bytes;
  std::filesystem::path folder;  ///< the folder of the files that the scene names
};

/// Returns the bytes of a scene file. Throws SceneFileError, and Failure (bad_scene) if stdin cannot be read.
RawScene scene_bytes(const std::filesystem::path& path, const std::string& format);

/// Reads a solution. Throws Failure (bad_scene) if the file is no solution or has no surface.
DisplayMesh read_solution(const std::filesystem::path& path, const std::string& format);

/// Throws Failure (bad_scene) if a solution tells no errors; `name` is its file, solve or scene.
void require_told_errors(const DisplayMesh& solution, const std::string& name);

/// Reads the points of `alvor probe`. Throws Failure (bad_scene) that names the line.
std::vector<ProbePoint> read_asked_points(const std::filesystem::path& path);

}  // namespace alvor
