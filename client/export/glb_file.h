#pragma once
// A solution as binary glTF 2.0: one node, one mesh, one primitive.

#include "meshing/display_mesh.h"

#include <string>
#include <string_view>

namespace alvor {

/// POSITION is relative to the node's translation, so that a scene far from the origin keeps its digits in float32.
/// Throws SolutionFileError ("place: reason") for a mesh without triangles or of 4 GB or more.
std::string encode_glb(const DisplayMesh& mesh);

/// Reads what encode_glb wrote. Checks every offset and count before it allocates: memory stays within a few times `bytes`.
/// Values and indices are as in the file: read_solution_file checks them. Throws SolutionFileError ("place: reason").
DisplayMesh decode_glb(std::string_view bytes);

}  // namespace alvor
