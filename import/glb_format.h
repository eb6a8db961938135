#pragma once
// Numbers of the glTF 2.0 and GLB specifications, as far as solution files use them.

#include <cstddef>
#include <cstdint>

namespace alvor::glb {

inline constexpr std::uint32_t magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
inline constexpr std::size_t file_header_size = 12, chunk_header_size = 8, vec3_size = 12;
inline constexpr int float_component = 5126, uint_component = 5125, array_buffer = 34962, element_array_buffer = 34963;
/// Ours has 2 kB; a parsed tree takes many times its text.
inline constexpr std::size_t largest_json = 1 << 20;

/// glTF is y-up: the node of a z-up solution is turned by this, and its extras say so under this key.
inline constexpr double z_up_rotation[4] = {-0.70710678118654752, 0, 0, 0.70710678118654752};
inline constexpr const char* up_key = "alvor_up";

}  // namespace alvor::glb
