#pragma once
// Bakes a solution into the colours of vertices.

#include "client/bake/bake.h"

namespace alvor {

/// Adds COLOR_0 to the vertices of `document`, as bake() does with textures, so that their materials show the colours of a picture
/// of the solution where base colour, image and vertex colour are multiplied: materials become unlit. Light that changes between
/// the vertices of a face is lost. Throws BakeError.
Baked bake_vertices(GltfDocument document, const Scene& scene, const DisplayMesh& solution, BakedSide side);

}  // namespace alvor
