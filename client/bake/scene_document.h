#pragma once
// Writes a scene of any format as a glTF file, to be baked.

#include "client/bake/gltf_document.h"
#include "meshing/scene.h"

namespace alvor {

/// Returns a document with a node for each object, in order, and one for the faces of no object; their names, materials, colours
/// of textures and texture coordinates. Faces of more corners are cut into triangles. Nodes hang from none, and their meshes are in
/// the scene's coordinates; the nodes of a z-up scene turn them upright. Requires: !find_fault(scene).
GltfDocument document_of(const Scene& scene);

}  // namespace alvor
