#pragma once
// Writes and reads a solution as binary glTF 2.0: one node, one mesh, one primitive.

#include "meshing/display_mesh.h"

#include <string>
#include <string_view>

namespace alvor {

/// Returns the bytes of a GLB file. POSITION is relative to the node's translation, so that a scene far from the origin keeps its
/// digits in float32. Throws SolutionFileError ("place: reason") for a mesh without triangles or of 4 GB or more.
std::string encode_glb(const DisplayMesh& mesh);

/// Reads the output of encode_glb. Checks every offset and count before it allocates, so memory stays within a few times `bytes`.
/// Does not check values and indices; read_solution_file does. Throws SolutionFileError ("place: reason").
DisplayMesh decode_glb(std::string_view bytes);

}  // namespace alvor
