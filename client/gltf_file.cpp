#include "client/gltf_file.h"

#include "client/import_error.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>

namespace alvor {

namespace {

constexpr std::size_t glb_header = 20;  ///< of the file and of its first chunk, the JSON
constexpr int max_depth = 200;

/// Extensions that change neither shape nor place, and so may be required of us.
bool is_harmless(const std::string& extension) {
  return extension.starts_with("KHR_materials_") || extension.starts_with("KHR_texture_") ||
         extension.starts_with("EXT_texture_") || extension == "KHR_mesh_quantization" || extension == "KHR_lights_punctual";
}

/// Keeps the encoded bytes, to be decoded when a material asks. Bytes of a buffer view are not touched: tinygltf does not check
/// its range.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size,
                  void*) {
  if (image->bufferView < 0 && size > 0) image->image.assign(bytes, bytes + size);
  return true;
}

std::string read_all(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw ImportError("file", "cannot be opened");
  std::string content{std::istreambuf_iterator<char>(stream), {}};
  if (content.size() > std::numeric_limits<std::uint32_t>::max()) throw ImportError("file", "is larger than 4 GB");
  return content;
}

/// tinygltf descends into values by recursion: a megabyte of brackets would overflow the stack. Brackets in a GLB's binary part
/// are not looked at, as the JSON part ends where its depth returns to 0.
void refuse_deep(std::string_view json) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (quoted && c == '\\') ++i;
    else if (c == '"') quoted = !quoted;
    else if (!quoted && (c == '[' || c == '{') && ++depth > max_depth) throw ImportError("file", "its JSON is nested too deeply");
    else if (!quoted && (c == ']' || c == '}') && --depth == 0) return;
  }
}

void refuse_unknown_extensions(const tinygltf::Model& model) {
  for (const std::string& extension : model.extensionsRequired)
    if (!is_harmless(extension)) throw ImportError("file", "requires the extension " + extension + ", which is not supported");
}

bool load(tinygltf::Model& model, const std::string& content, bool binary, const std::string& folder, std::string& error) {
  tinygltf::TinyGLTF loader;
  loader.SetImageLoader(keep_encoded, nullptr);
  std::string warning;
  const auto size = static_cast<unsigned>(content.size());
  if (!binary) return loader.LoadASCIIFromString(&model, &error, &warning, content.data(), size, folder);
  const auto* bytes = reinterpret_cast<const unsigned char*>(content.data());
  return loader.LoadBinaryFromMemory(&model, &error, &warning, bytes, size, folder);
}

}  // namespace

tinygltf::Model load_gltf(const std::filesystem::path& path) {
  const std::string content = read_all(path);
  const bool binary = content.starts_with("glTF");
  refuse_deep(std::string_view(content).substr(binary ? std::min(glb_header, content.size()) : 0));
  tinygltf::Model model;
  std::string error;
  if (!load(model, content, binary, path.parent_path().string(), error))
    throw ImportError("file", error.empty() ? "is not glTF" : error);
  refuse_unknown_extensions(model);
  return model;
}

}  // namespace alvor
