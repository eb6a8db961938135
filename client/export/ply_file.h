#pragma once
// A solution as binary little-endian PLY.

#include "meshing/display_mesh.h"

#include <string>
#include <string_view>

namespace alvor {

/// Vertices: x y z (double), nx ny nz, irradiance_r g b, radiosity_r g b (float), red green blue (uchar, tone mapped, sRGB).
/// Faces: list uchar int vertex_indices. Throws SolutionFileError ("place: reason").
std::string encode_ply(const DisplayMesh& mesh);

/// Reads what encode_ply wrote; comments are allowed. Checks the counts against the size before it allocates.
/// Values and indices are as in the file: read_solution_file checks them. Throws SolutionFileError ("place: reason").
DisplayMesh decode_ply(std::string_view bytes);

}  // namespace alvor
