#pragma once
// tinygltf, compiled into this project (tiny_gltf.cpp) in a namespace that no library has. libdraco, which Assimp loads, exports
// functions of another version of tinygltf: calls to a shared libtinygltf ended there, and wrote beyond their objects.
// Images and buffers outside the JSON are read by gltf_file.cpp, images are decoded by texture_colour.cpp.

#include <fstream>  // for tiny_gltf.h, which leaves it out under TINYGLTF_NO_FS
#include <nlohmann/json.hpp>

#define TINYGLTF_NO_INCLUDE_JSON
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#define TINYGLTF_NO_FS
#define tinygltf alvor_tinygltf
#include <tiny_gltf.h>
#undef tinygltf

namespace tinygltf = alvor_tinygltf;
