#pragma once
// Includes tinygltf, compiled into this project (tiny_gltf.cpp) in a namespace that no library uses. libdraco, which Assimp
// loads, exports functions of another version of tinygltf; calls to a shared libtinygltf reached those, which wrote beyond our
// objects.
// gltf_file.cpp reads images and buffers outside the JSON; image_file.cpp decodes images.

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
