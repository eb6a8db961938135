#pragma once
// Reads files that a scene file names, only from the scene's own folder.

#include <filesystem>
#include <string>

namespace alvor {

/// Returns the bytes of the file that a relative URI names, after decoding percent-encoded bytes (RFC 3986). Reads only from
/// `folder` and folders below it. Throws ImportError with `place` and the name for an absolute path, a URL, a name that leaves
/// the folder ("../"), and a file that is missing or cannot be read.
std::string read_file_beside(const std::filesystem::path& folder, const std::string& uri, const std::string& place);

}  // namespace alvor
