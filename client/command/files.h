#pragma once
// Files that options name.

#include "meshing/display_mesh.h"

#include <filesystem>
#include <string>

namespace alvor {

/// Throws Failure (usage), naming `option`, if no file can be made at `path`: no such folder, or not ours to write.
void require_writable(const std::filesystem::path& path, const std::string& option);

/// Throws Failure (bad_scene) if it is no solution or holds no surface.
DisplayMesh read_solution(const std::filesystem::path& path);

}  // namespace alvor
