#include "client/bake/gltf_parts.h"

#include "import/base/bytes.h"
#include "import/base/glb_format.h"

#include <absl/strings/escaping.h>

namespace alvor {

namespace {

using nlohmann::json;

constexpr int deepest = 200;  // levels of JSON, as the importer allows

std::string_view take_chunk(std::string_view& rest, std::uint32_t type) {
  if (rest.size() < glb::chunk_header_size || value_at<std::uint32_t>(rest, 4) != type)
    throw BakeError("file", "is no whole GLB");
  const std::size_t size = value_at<std::uint32_t>(rest, 0);
  if (size > rest.size() - glb::chunk_header_size) throw BakeError("file", "ends within a chunk");
  const std::string_view chunk = rest.substr(glb::chunk_header_size, size);
  rest.remove_prefix(glb::chunk_header_size + size);
  return chunk;
}

}  // namespace

json parse_gltf(std::string_view text) {
  const auto refuse_deep = [](int depth, json::parse_event_t, json&) {
    if (depth > deepest) throw BakeError("file", "its JSON is nested too deeply");
    return true;
  };
  json root;
  try {
    root = json::parse(text, refuse_deep);
  } catch (const json::parse_error& error) {
    throw BakeError("file", "its JSON is broken at byte " + std::to_string(error.byte));
  }
  if (!root.is_object()) throw BakeError("file", "is no glTF");
  return root;
}

GltfParts parts_of(std::string_view bytes) {
  if (!bytes.starts_with("glTF")) return {bytes, {}};
  if (bytes.size() < glb::file_header_size) throw BakeError("file", "ends within its header");
  std::string_view rest = bytes.substr(glb::file_header_size);
  GltfParts parts{take_chunk(rest, glb::json_chunk), {}};
  if (!rest.empty()) parts.binary = take_chunk(rest, glb::binary_chunk);
  return parts;
}

std::string bytes_of(const std::string& uri, const FileFinder& find, const std::string& place) {
  if (uri.starts_with("data:")) {
    const std::size_t comma = uri.find(',');
    std::string bytes;
    if (comma == std::string::npos || !absl::Base64Unescape(uri.substr(comma + 1), &bytes))
      throw BakeError(place, "its data URI is not base64");
    return bytes;
  }
  auto bytes = find(uri);
  if (!bytes) throw BakeError(place, "the file '" + uri + "' is missing");
  return *std::move(bytes);
}

}  // namespace alvor
