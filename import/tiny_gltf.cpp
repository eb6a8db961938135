#define TINYGLTF_IMPLEMENTATION
#include "import/tiny_gltf.h"
