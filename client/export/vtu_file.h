#pragma once
// Solutions for ParaView: VTK's unstructured grid, .vtu.

#include "meshing/display_mesh.h"

#include <string>

namespace alvor {

/// Returns the bytes of a .vtu file of triangles. Points have the vectors irradiance and radiosity, and error if errors were
/// told. Cells have face (the face of the scene, or -1), material, and object (numbers, or -1). Values are float32, W/m2 or lx;
/// places float64, metres. Binary data follow the XML, as VTK's "appended raw" format has it, little endian.
std::string encode_vtu(const DisplayMesh& mesh);

}  // namespace alvor
