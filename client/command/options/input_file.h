#pragma once
// Files that a command reads, one of which may come from stdin.

#include "client/verify/probe.h"
#include "import/scene_file.h"
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

/// Adds `--format`: the format of a scene or solution from stdin, as a suffix would tell it: "glb".
void add_format_option(CLI::App& command, std::string& format);

/// Throws Failure (usage) unless the inputs of a command go together: at most one of them is stdin, and `format` is given and
/// known exactly where that is a scene or a solution.
void require_inputs(std::initializer_list<InputFile> inputs, const std::string& format);

// `format` is that of stdin. Requires of all three: require_inputs has returned.

/// Reads a scene; the files that one from stdin names are in the working folder. Throws SceneFileError, and Failure (bad_scene)
/// if stdin cannot be read.
SceneFile read_scene(const std::filesystem::path& path, const std::string& format);

/// Throws Failure (bad_scene) if it is no solution or holds no surface.
DisplayMesh read_solution(const std::filesystem::path& path, const std::string& format);

/// Throws Failure (bad_scene) that names the line.
std::vector<ProbePoint> read_asked_points(const std::filesystem::path& path);

}  // namespace alvor
