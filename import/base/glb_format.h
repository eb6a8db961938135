#pragma once
// Numbers of the glTF 2.0 and GLB specifications that solution files use.

#include <cstddef>
#include <cstdint>

namespace alvor::glb {

inline constexpr std::uint32_t magic = 0x46546c67, json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
inline constexpr std::size_t file_header_size = 12, chunk_header_size = 8, vec3_size = 12;
inline constexpr int float_component = 5126, uint_component = 5125, array_buffer = 34962, element_array_buffer = 34963;
inline constexpr std::size_t triangle_list = 4;  ///< the mode of a primitive
/// Limit for the JSON of a solution file; ours has 2 kB, 350 bytes a light, up to 220 kB an environment map, 150 bytes a material
/// and up to 400 an object. A parsed tree takes many times the memory of its text.
inline constexpr std::size_t largest_json = 1 << 26;

/// glTF is y-up. In a z-up solution this rotation (quaternion x, y, z, w) turns the node, and the node's extras mark it with
/// `up_key`.
inline constexpr double z_up_rotation[4] = {-0.70710678118654752, 0, 0, 0.70710678118654752};
inline constexpr const char* up_key = "alvor_up";
/// Keys of the same extras: what the numbers mean, and the lights that are not faces.
inline constexpr const char *quantity_key = "alvor_quantity", *lights_key = "alvor_lights";
/// Keys of the same extras: lists of the scene's materials and objects, and the number of the accessor that tells whence the
/// triangles come: for each run of triangles on one face of the scene that face, the second face if two triangles were joined
/// into a quad (else 2^32 - 1), the material, and the number of triangles.
inline constexpr const char *materials_key = "alvor_materials", *objects_key = "alvor_objects", *faces_key = "alvor_faces";
/// Key of the same extras: a list of the materials that have a texture, each with its image among those of the file, a factor, and
/// the wrap modes of glTF.
inline constexpr const char* textures_key = "alvor_textures";
inline constexpr int repeat = 10497, mirrored_repeat = 33648, clamp_to_edge = 33071;

}  // namespace alvor::glb
