#pragma once

#include <filesystem>

namespace alvor_tinygltf {
class Model;
}
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// Parses a glTF 2.0 file, text or binary. Images keep their encoded bytes, those in buffer views stay there. Numbers and indices
/// are as in the file, not checked. Throws ImportError, also for required extensions that change shapes in ways not known here.
tinygltf::Model load_gltf(const std::filesystem::path& path);

}  // namespace alvor
