#pragma once
// The compact solution file, .alvor: root patches and one state of a solution (proto/alvor/v1/solution_file.proto).

#include "meshing/base_mesh.h"
#include "meshing/display_mesh.h"

#include <span>
#include <string>
#include <string_view>

namespace alvor {

/// Returns the bytes of a file, without roots that are hidden. `leaves` are sorted by id and cover every root; `errors` are their
/// told errors, or none. Values
/// are rounded to nine bits a band and a common exponent, an error of at most 0.2 % of the brightest band; errors to a byte.
/// About six bytes a leaf. Throws SolutionFileError if there are more leaves than a file can hold.
std::string encode_compact(const BaseMesh& mesh, std::span<const LeafValue> leaves, std::span<const float> errors = {});

/// Returns the mesh of such a file: what build_display_mesh() made of the values that it holds. Throws SolutionFileError.
DisplayMesh decode_compact(std::string_view bytes);

}  // namespace alvor
