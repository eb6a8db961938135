#pragma once
// Cuts the triangles of a glTF file's meshes into smaller ones, so that colours at vertices can show light that changes on a
// face.

#include "client/bake/gltf_document.h"

namespace alvor {

/// Halves edges, those that are longer than `longest_edge` in the scene where a mesh is shown largest, until none is left. New
/// vertices have the mean of all attributes at the two ends of their edge, normals and tangents of length 1. Triangles with a
/// common edge cut it at the same places, so no gaps open, also where their vertices differ. Primitives of lines and points,
/// and those that a skin moves, stay as they are. Throws BakeError, also if a mesh would have more than 10 million vertices.
/// longest_edge: metres, above 0.
void subdivide(GltfDocument& document, double longest_edge);

}  // namespace alvor
