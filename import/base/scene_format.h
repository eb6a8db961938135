#pragma once

#include <cctype>
#include <filesystem>
#include <string>
#include <string_view>

namespace alvor {

/// Returns the extension with its dot in lower case: ".glb"; empty if there is none.
inline std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

/// Returns whether files with this extension, in lower case with its dot, are environment maps.
inline bool is_environment_extension(std::string_view extension) { return extension == ".hdr" || extension == ".exr"; }

}  // namespace alvor
