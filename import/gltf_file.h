#pragma once

#include <filesystem>
#include <string_view>

namespace alvor_tinygltf {
class Model;
}
namespace tinygltf = alvor_tinygltf;

namespace alvor {

/// Parses the bytes of a glTF 2.0 file, text or binary; files that it names are read from `folder`. Images stay encoded, those in
/// buffer views stay there. Numbers and indices are not checked. Throws ImportError, also for required extensions that change
/// shapes in ways not known here.
tinygltf::Model load_gltf(std::string_view content, const std::filesystem::path& folder);

}  // namespace alvor
