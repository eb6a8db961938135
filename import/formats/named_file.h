#pragma once
// Finds files that a scene file names by URIs.

#include "import/base/scene_files.h"

#include <string>
#include <string_view>

namespace alvor {

/// Returns the name that a relative URI stands for: its percent-encoded bytes are decoded (RFC 3986).
std::string decoded_uri(std::string_view uri);

/// Returns the bytes of the file that a relative URI names. Throws ImportError with `place` and the name for an absolute path, a
/// URL and a name that leaves the folder of the scene ("../"), and MissingFileError.
const std::string& file_of_uri(SceneFiles& files, const std::string& uri, const std::string& place);

}  // namespace alvor
