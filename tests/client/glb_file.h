#pragma once
// Builds glTF files for tests.

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace alvor {

/// The binary part of a glTF file, filled piece by piece.
struct GltfBytes {
  std::string bytes;

  template <class T>
  GltfBytes& add(const std::vector<T>& numbers) {
    bytes.append(reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(T));
    bytes.resize((bytes.size() + 3) / 4 * 4);
    return *this;
  }
};

/// A binary glTF file that exists as long as the object. `json` is given without its braces, `asset` and `buffers`.
class GlbFile {
 public:
  GlbFile(const std::string& json, const GltfBytes& content)
      : path_(std::filesystem::temp_directory_path() / ("alvor_" + std::to_string(::getpid()) + ".glb")) {
    const std::string size = std::to_string(content.bytes.size());
    std::string text = R"({"asset": {"version": "2.0"}, "buffers": [{"byteLength": )" + size + "}], " + json + "}";
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::string chunks = chunk("JSON", text) + chunk(std::string("BIN\0", 4), content.bytes);
    std::ofstream(path_, std::ios::binary) << "glTF" << little_endian(2) << little_endian(12 + chunks.size()) << chunks;
  }
  ~GlbFile() { std::filesystem::remove(path_); }
  GlbFile(const GlbFile&) = delete;
  GlbFile& operator=(const GlbFile&) = delete;

  operator const std::filesystem::path&() const { return path_; }

 private:
  static std::string little_endian(std::size_t value) {
    std::string bytes(4, '\0');
    for (std::size_t i = 0; i < 4; ++i) bytes[i] = static_cast<char>(value >> (8 * i) & 0xff);
    return bytes;
  }
  static std::string chunk(const std::string& type, const std::string& content) {
    return little_endian(content.size()) + type + content;
  }

  std::filesystem::path path_;
};

}  // namespace alvor
