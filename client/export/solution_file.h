#pragma once
// Writes solution files, and reads them for probing and rendering.

#include "meshing/display_mesh.h"

#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace alvor {

/// Thrown where a solution file cannot be read or written. what() is one line: file, place, reason.
struct SolutionFileError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writes a solution; the extension chooses the format. .glb has float attributes _RADIOSITY and _IRRADIANCE, W/m2, and
/// _TRANSMITTED if a material is translucent, _ERROR if errors were told (see DisplayMesh), a tone-mapped COLOR_0 under an unlit
/// material, positions relative to the node's translation, and a rotated node if the solution is z-up. .ply (binary little
/// endian) has the values as vertex properties, `error` among them. .vtu: see encode_vtu(); it cannot be read again. For .alvor
/// see encode_compact() (compact_file.h). The file appears whole or not at all. Throws SolutionFileError.
void write_solution_file(const std::filesystem::path& path, const DisplayMesh& mesh);

/// Reads a solution: .glb, .ply or .alvor. Throws SolutionFileError, also for any other GLB or PLY.
DisplayMesh read_solution_file(const std::filesystem::path& path);

/// Returns whether bytes of this extension are meant as a solution: scenes come as GLB and PLY, too. They may have faults.
bool is_solution(std::string_view bytes, const std::string& extension);

/// Returns the bytes that write_solution_file writes to a file of this extension: ".glb", ".ply" or ".vtu". Throws
/// SolutionFileError.
std::string encode_solution(const DisplayMesh& mesh, const std::string& extension);

/// Reads the bytes of a solution, whose extension is ".glb", ".ply" or ".alvor". Throws SolutionFileError that begins with
/// `name`.
DisplayMesh decode_solution(std::string_view bytes, const std::string& extension, const std::string& name);

/// Throws SolutionFileError if objects cannot be those of one scene.
void check_objects(std::span<const SceneObject> objects);

}  // namespace alvor
