#pragma once
// Writes and reads a solution as binary little-endian PLY.

#include "meshing/display_mesh.h"

#include <string>
#include <string_view>

namespace alvor {

/// Returns the bytes of a PLY file. Vertices: x y z (double), nx ny nz, irradiance_r g b, radiosity_r g b (float), red green blue
/// (uchar, tone mapped, sRGB). Faces: list uchar int vertex_indices. Throws SolutionFileError ("place: reason").
std::string encode_ply(const DisplayMesh& mesh);

/// Reads the output of encode_ply; comments are allowed. Checks the counts against the size before it allocates. Does not check
/// values and indices; read_solution_file does. Throws SolutionFileError ("place: reason").
DisplayMesh decode_ply(std::string_view bytes);

}  // namespace alvor
