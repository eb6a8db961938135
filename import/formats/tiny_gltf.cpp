#define TINYGLTF_IMPLEMENTATION
#include "import/formats/tiny_gltf.h"
