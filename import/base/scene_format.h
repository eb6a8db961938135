#pragma once

#include <cctype>
#include <filesystem>
#include <string>

namespace alvor {

/// Returns the extension with its dot in lower case: ".glb"; empty if there is none.
inline std::string lower_case_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

}  // namespace alvor
