#include "import/formats/named_file.h"

#include <charconv>

namespace alvor {

std::string decoded_uri(std::string_view uri) {
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

const std::string& file_of_uri(SceneFiles& files, const std::string& uri, const std::string& place) {
  const std::string name = decoded_uri(uri), named = place + " '" + name + "'";
  if (const std::string reason = reason_against_name(name); !reason.empty()) throw ImportError(named, reason);
  if (const std::string* bytes = files.find(name)) return *bytes;
  throw MissingFileError(named, "is missing beside the scene");
}

}  // namespace alvor
