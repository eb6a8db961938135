#define TINYGLTF_IMPLEMENTATION
#include "client/tiny_gltf.h"
