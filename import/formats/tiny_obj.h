#pragma once
// tinyobjloader with numbers in double precision. obj_import.cpp compiles its implementation.

#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>
