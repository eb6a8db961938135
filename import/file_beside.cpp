#include "import/file_beside.h"

#include "import/import_error.h"
#include "import/whole_file.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace alvor {

namespace {

std::string percent_decoded(std::string_view uri) {
  std::string name;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    unsigned char byte = 0;
    const char* const digits = uri.data() + i + 1;
    const bool encoded = uri[i] == '%' && i + 2 < uri.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2;
    name += encoded ? static_cast<char>(byte) : uri[i];
    if (encoded) i += 2;
  }
  return name;
}

/// Returns why a name cannot be a file in the scene's folder or below it; empty if it can. Backslashes count as separators, for
/// names from Windows.
std::string reason_against(const std::string& name) {
  if (name.empty()) return "names no file";
  if (std::ranges::any_of(name, [](char c) { return static_cast<unsigned char>(c) < ' '; })) return "has control characters";
  if (name.find(':') != std::string::npos) return "is a URL or names a drive: only files beside the scene are read";
  if (name.front() == '/' || name.front() == '\\') return "is an absolute path: only files beside the scene are read";
  for (std::size_t start = 0; start <= name.size();) {
    const std::size_t end = std::min(name.find_first_of("/\\", start), name.size());
    if (std::string_view(name).substr(start, end - start) == "..") return "leaves the folder of the scene";
    start = end + 1;
  }
  return {};
}

}  // namespace

std::string read_file_beside(const std::filesystem::path& folder, const std::string& uri, const std::string& place) {
  const std::string name = percent_decoded(uri), named = place + " '" + name + "'";
  if (const std::string reason = reason_against(name); !reason.empty()) throw ImportError(named, reason);
  std::error_code ignored;
  if (!std::filesystem::exists(folder / name, ignored)) throw ImportError(named, "is missing beside the scene");
  try {
    return read_whole_file(folder / name);
  } catch (const FileError& error) {
    throw ImportError(named, "cannot be read: " + std::string(error.what()));
  }
}

}  // namespace alvor
