// Tests which files an importer asks for.

#include "import/base/import_error.h"
#include "import/formats/import_scene.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

using Names = std::vector<std::string>;

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

SceneFiles room() {
  return {"room.obj", "mtllib walls.mtl lamps.mtl\n" + triangle + "usemtl wood\nf 1 2 3\nusemtl lamp\nf 1 2 3\n"};
}

Names missing(SceneFiles& files) { return import_scene(files, {}).missing; }

/// Reads the scene without the files that are missing.
ImportedScene without(const SceneFiles& files) {
  SceneFiles all(files.scene(), files.bytes());
  for (const auto& [name, bytes] : files.beside()) all.add(name, bytes);
  v1::ImportOptions options;
  for (const std::string& name : files.missing()) options.add_absent_files(name);
  return import_scene(all, options);
}

TEST(MissingFiles, OfObjAreAllLibrariesAndThenAllImagesOfMaterialsInUse) {
  SceneFiles files = room();
  EXPECT_EQ(missing(files), (Names{"lamps.mtl", "walls.mtl"}));
  files = room();
  files.add("walls.mtl", "newmtl wood\nKd .5 .5 .5\nmap_Kd maps\\wood.png\nnewmtl brick\nKd 1 1 1\nmap_Kd brick.png\n");
  EXPECT_EQ(missing(files), Names{"lamps.mtl"});
  files.add("lamps.mtl", "newmtl lamp\nKe 1 1 1\nmap_Ke ./glow.png\nmap_Bump bumps.png\n");
  SceneFiles all = room();
  for (const auto& [name, bytes] : files.beside()) all.add(name, bytes);
  EXPECT_EQ(missing(all), (Names{"glow.png", "maps/wood.png"}));
  const ImportedScene scene = without(all);
  EXPECT_EQ(scene.missing, Names{});
  EXPECT_EQ(scene.file.warnings, (Names{"material 'wood': texture 'maps/wood.png' cannot be read and is left out",
                                        "material 'lamp': texture './glow.png' cannot be read and is left out"}));
}

TEST(MissingFiles, AreNotThoseThatNoSceneMayName) {
  SceneFiles files("room.obj", "mtllib /etc/passwd.mtl\nmtllib ../up.mtl\nmtllib C:\\lamps.mtl\n" + triangle + "f 1 2 3\n");
  EXPECT_EQ(missing(files), Names{});
}

constexpr const char* gltf = R"({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
  "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
  "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
  "bufferViews": [{"buffer": 0, "byteLength": 36}],
  "buffers": [{"byteLength": 36, "uri": "a%20b.bin"}, {"byteLength": 4, "uri": "deep/c.bin"}],
  "images": [{"uri": "wood.png"}, {"uri": "bumps.png"}, {"uri": "glow.png"}],
  "textures": [{"source": 0}, {"source": 1}, {"source": 2}],
  "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "normalTexture": {"index": 1},
                 "emissiveTexture": {"index": 2}}]})";

TEST(MissingFiles, OfGltfAreItsBuffersAndTheImagesThatGiveColour) {
  SceneFiles files("room.gltf", gltf);
  EXPECT_EQ(missing(files), (Names{"a b.bin", "deep/c.bin", "glow.png", "wood.png"}));
  try {
    without(files);
    FAIL() << "a buffer is needed";
  } catch (const ImportError& error) {
    EXPECT_STREQ(error.what(), "buffer 0 'a b.bin': is missing beside the scene");
  }
}

TEST(MissingFiles, OfGltfWithStrangeReferencesAreNone) {
  for (const char* strange :
       {R"({"asset": {"version": "2.0"}, "materials": 3, "buffers": {"uri": "a"}})",
        R"({"asset": {"version": "2.0"}, "materials": [{"emissiveTexture": {"index": 7}}], "textures": [1]})",
        R"({"asset": {"version": "2.0"}, "materials": [[]], "images": [{"uri": 5}], "textures": [{"source": 0}]})", "[]", "5"}) {
    SceneFiles files("room.gltf", strange);
    EXPECT_THROW(import_scene(files, {}), ImportError) << strange;
    EXPECT_TRUE(files.missing().empty()) << strange;
  }
}

TEST(MissingFiles, AreAskedForInPlainNames) {
  EXPECT_EQ(plain_name(".\\maps//wood.png"), "maps/wood.png");
  EXPECT_EQ(reason_against_name("maps/..\\..\\wood.png"), "leaves the folder of the scene");
  EXPECT_EQ(reason_against_name(std::string(2000, 'a')), "has a name of more than 1000 bytes");
  EXPECT_EQ(reason_against_name("wood..png"), "");
  EXPECT_EQ(reason_against_name("h\xc3\xb6lz.png"), "");
  EXPECT_EQ(reason_against_name("h\xf6lz.png"), "has a name that is not UTF-8");
}

TEST(ImportOptions, ReplaceWhatTheFileSays) {
  v1::ImportOptions options;
  options.set_quantity(v1::QUANTITY_PHOTOMETRIC);
  options.set_up_axis(v1::UP_AXIS_Z);
  options.mutable_absorption_per_meter()->set_g(0.5);
  SceneFiles files("room.obj", triangle + "f 1 2 3\n");
  const Scene scene = import_scene(files, options).file.scene;
  EXPECT_EQ(scene.quantity, Quantity::photometric);
  EXPECT_EQ(scene.up, UpAxis::z);
  EXPECT_EQ(scene.absorption, (Rgb{0, 0.5, 0}));
}

}  // namespace
}  // namespace alvor
