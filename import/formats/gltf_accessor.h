#pragma once
// Reads numbers out of glTF buffers and JSON values. Checks every range before reading, as the file may be hostile.

#include "meshing/texture.h"
#include "meshing/vec3.h"

#include <cstdint>
#include <span>
#include <vector>

namespace alvor_tinygltf {
class Model;
class Value;
}  // namespace alvor_tinygltf
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// Returns the bytes of a buffer view. Throws ImportError if there is no such view or it leaves its buffer.
std::span<const unsigned char> bytes_of_view(const tinygltf::Model& model, int view);

/// Returns the positions in an accessor. Throws ImportError that names the accessor if it has the wrong type, leaves its buffer
/// view, or is sparse.
std::vector<Vec3> read_positions(const tinygltf::Model& model, int accessor);
/// Returns the texture coordinates in an accessor. Throws ImportError as read_positions does.
std::vector<TexturePoint> read_texture_points(const tinygltf::Model& model, int accessor);
/// Returns the colours in an accessor, in [0, 1] and without their alpha. Throws ImportError as read_positions does.
std::vector<RgbF> read_colours(const tinygltf::Model& model, int accessor);
/// Returns the indices in an accessor. Throws ImportError as read_positions does.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor);

/// Returns the number `name` of a JSON object; `otherwise` if it is no object or has no such number.
double number_in(const tinygltf::Value& object, const char* name, double otherwise);

}  // namespace alvor
