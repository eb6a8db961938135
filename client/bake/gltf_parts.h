#pragma once
// The parts that a glTF 2.0 file consists of: its JSON, its binary data, and what its URIs name.

#include "client/bake/gltf_document.h"

#include <optional>
#include <string>
#include <string_view>

namespace alvor {

/// The two parts of a file, within its bytes. A text file has no binary part.
struct GltfParts {
  std::string_view text;
  std::optional<std::string_view> binary;
};

/// Returns the parts of a .gltf or .glb file. Throws BakeError.
GltfParts parts_of(std::string_view bytes);
/// Returns the JSON object of a file. Throws BakeError, also if it is nested too deeply.
nlohmann::json parse_gltf(std::string_view text);
/// Returns the bytes that a URI names, of a file or within it. Throws BakeError that names `place`.
std::string bytes_of(const std::string& uri, const FileFinder& find, const std::string& place);

}  // namespace alvor
