// Tests of glTF files in several parts: which parts are read, and which refused.

#include "import/apart/scene_file.h"
#include "tests/import/texture_images.h"

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <fstream>

namespace alvor {
namespace {

namespace fs = std::filesystem;

/// Makes a folder with a triangle in two files and removes it afterwards.
class PartsTest : public testing::Test {
 protected:
  PartsTest() {
    fs::create_directories(folder / "parts");
    write("parts/a b.bin", triangle());
  }
  ~PartsTest() override { fs::remove_all(folder.parent_path()); }

  static std::string triangle() {
    const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    std::string bytes(sizeof positions, '\0');
    std::memcpy(bytes.data(), positions, sizeof positions);
    return bytes;
  }
  void write(const fs::path& name, const std::string& bytes) const { std::ofstream(folder / name, std::ios::binary) << bytes; }

  /// Writes a scene whose buffer has this URI, and reads it. Returns "accepted", or why it was refused.
  std::string read(const std::string& uri, const nlohmann::json& images = {}, const nlohmann::json& material = colour) const {
    nlohmann::json gltf = {{"asset", {{"version", "2.0"}}},
                           {"scene", 0},
                           {"scenes", {{{"nodes", {0}}}}},
                           {"nodes", {{{"mesh", 0}}}},
                           {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
                           {"accessors", {{{"bufferView", 0}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}}}},
                           {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
                           {"buffers", {{{"byteLength", 36}, {"uri", uri}}}}};
    if (!images.is_null()) {
      gltf["images"] = images;
      gltf["textures"] = {{{"source", 0}}};
      gltf["materials"] = {material};
    }
    write("scene.gltf", gltf.dump());
    try {
      EXPECT_EQ(read_scene_file(folder / "scene.gltf").scene.faces.size(), 1u);
      return "accepted";
    } catch (const SceneFileError& error) {
      return std::string(error.what()).substr((folder / "scene.gltf").string().size() + 2);
    }
  }

  inline static const nlohmann::json colour = {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}};
  const fs::path folder = fs::temp_directory_path() / ("alvor_parts_" + std::to_string(getpid())) / "scene";
};

TEST_F(PartsTest, AreReadFromTheFolderAndBelow) {
  EXPECT_EQ(read("parts/a%20b.bin"), "accepted");
  EXPECT_EQ(read("parts/a b.bin"), "accepted");
  write("a+b%.bin", triangle() + "padding");
  EXPECT_EQ(read("a+b%25.bin"), "accepted");
}

TEST_F(PartsTest, ThatLeaveTheFolderAreRefused) {
  write("../outside.bin", triangle());
  for (const char* uri : {"../outside.bin", "parts/../../outside.bin", "%2e%2e/outside.bin", "..\\outside.bin"})
    EXPECT_NE(read(uri).find("outside.bin': leaves the folder of the scene"), std::string::npos) << uri << ": " << read(uri);
  EXPECT_EQ(read((folder / "parts/a b.bin").string()),
            "buffer 0 '" + (folder / "parts/a b.bin").string() + "': is an absolute path: only files beside the scene are read");
  for (const char* uri : {"http://example.com/a.bin", "file:///etc/passwd", "C:\\a.bin", "FILE:a.bin"})
    EXPECT_NE(read(uri).find("is a URL or names a drive"), std::string::npos) << uri;
}

TEST_F(PartsTest, ThatAreMissingOrTooShortAreRefusedByName) {
  EXPECT_EQ(read("nowhere.bin"), "buffer 0 'nowhere.bin': is missing beside the scene");
  write("short.bin", "short");
  EXPECT_EQ(read("short.bin"), "buffer 0 'short.bin': is too short: 5 of 36 bytes");
  EXPECT_EQ(read(""), "buffer 0: names no file");
  EXPECT_EQ(read("parts"), "buffer 0 'parts': is missing beside the scene");
}

TEST_F(PartsTest, CanBeImages) {
  EXPECT_EQ(read("parts/a b.bin", {{{"uri", "nowhere.png"}}}), "image 0 'nowhere.png': is missing beside the scene");
  EXPECT_EQ(read("parts/a b.bin", {{{"uri", "../../a.png"}}}), "image 0 '../../a.png': leaves the folder of the scene");
  EXPECT_EQ(read("parts/a b.bin", {{{"uri", "parts/a%20b.bin"}}}), "accepted");
  const nlohmann::json bumps = {{"normalTexture", {{"index", 0}}}};
  EXPECT_EQ(read("parts/a b.bin", {{{"uri", "nowhere.png"}}}, bumps), "accepted");
}

// The importer may make few system calls, see import/program/sandbox.cpp.
TEST_F(PartsTest, CanBeWebpWhichTheRestrictedImporterDecodes) {
  const test::Texels texels(1 << 16, {188, 100, 20, 200});
  for (const bool is_lossless : {true, false}) {
    write("wood.webp", test::webp(256, texels, {.is_lossless = is_lossless}));
    EXPECT_EQ(read("parts/a b.bin", {{{"uri", "wood.webp"}}}), "accepted");
    const auto warnings = read_scene_file(folder / "scene.gltf").warnings;
    EXPECT_TRUE(std::ranges::none_of(warnings, [](const std::string& text) { return text.find("cannot be read") != text.npos; }));
  }
}

}  // namespace
}  // namespace alvor
