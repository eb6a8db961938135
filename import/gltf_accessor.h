#pragma once
// Numbers out of glTF buffers. Nothing in the file is trusted: every range is checked before it is read.

#include "meshing/vec3.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor_tinygltf {
class Model;
}
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// The bytes of a buffer view. Throws ImportError when there is no such view or it leaves its buffer.
std::span<const unsigned char> bytes_of_view(const tinygltf::Model& model, int view);

/// Each throws ImportError that names the accessor when it is not of the right type, leaves its buffer view, or is sparse.
std::vector<Vec3> read_positions(const tinygltf::Model& model, int accessor);
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor);

}  // namespace alvor
