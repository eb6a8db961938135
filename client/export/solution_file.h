#pragma once
// Solution files out, and in again for probing and rendering.

#include "meshing/display_mesh.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace alvor {

/// A solution file that cannot be read or written. what() is one line: file, place, reason.
struct SolutionFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// By extension: .glb (float attributes _RADIOSITY and _IRRADIANCE, W/m2, and a tone-mapped COLOR_0 under an unlit material,
/// positions relative to a node's translation, the node turned where the solution is z-up) or .ply (binary little endian, the
/// same as vertex properties). The file appears whole or not at all. Throws SolutionFileError.
void write_solution_file(const std::filesystem::path& path, const DisplayMesh& mesh);

/// Reads what write_solution_file wrote. Throws SolutionFileError, also for any other GLB or PLY.
DisplayMesh read_solution_file(const std::filesystem::path& path);

/// Returns the bytes that write_solution_file writes to a file of this extension: ".glb" or ".ply". Throws SolutionFileError.
std::string encode_solution(const DisplayMesh& mesh, const std::string& extension);

/// Reads the bytes of such a file. Throws SolutionFileError that begins with `name`.
DisplayMesh decode_solution(std::string_view bytes, const std::string& extension, const std::string& name);

}  // namespace alvor
