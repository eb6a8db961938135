// Tests the objects and names that scenes get when they are read.

#include "import/base/unique_names.h"
#include "import/formats/import_scene.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

using Names = std::vector<std::string>;

Names unique(Names names) {
  std::vector<std::string*> all;
  for (std::string& name : names) all.push_back(&name);
  make_unique(all, "object");
  return names;
}

TEST(UniqueNames, NumberWhatAFileHasTwice) {
  EXPECT_EQ(unique({"chair", "table", "chair", "chair"}), (Names{"chair", "table", "chair.001", "chair.002"}));
  EXPECT_EQ(unique({"", "", "object"}), (Names{"object", "object.001", "object.002"}));
}

TEST(UniqueNames, AreNotThoseThatTheFileHasItself) {
  EXPECT_EQ(unique({"chair", "chair", "chair.001", "chair.001"}), (Names{"chair", "chair.002", "chair.001", "chair.001.001"}));
}

TEST(UniqueNames, AreUtf8) { EXPECT_EQ(unique({"\xff", "\xfe"}), (Names{"?", "?.001"})); }

TEST(UniqueNames, AreCutBetweenCharacters) {
  std::string umlauts = "x";
  for (int n = 0; n < 1000; ++n) umlauts += "\u00fc";
  const Names names = unique({umlauts, umlauts});
  EXPECT_EQ(names[0], umlauts.substr(0, 899));
  EXPECT_EQ(names[1], umlauts.substr(0, 899) + ".001");
}

TEST(UniqueNames, OfAMillionEqualOnesTakeLinearTime) {
  const Names names = unique(Names(1'000'000, "leaf"));
  EXPECT_EQ(names.back(), "leaf.999999");
}

/// Returns the objects of an OBJ file: name, parent and number of faces.
std::vector<std::tuple<std::string, int, int>> objects_of(const std::string& lines) {
  SceneFiles files("room.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + lines);
  std::vector<std::tuple<std::string, int, int>> objects;
  for (const SceneObject& object : import_scene(files, {}).file.scene.objects)
    objects.emplace_back(object.name, object.parent ? static_cast<int>(*object.parent) : -1, static_cast<int>(object.face_count));
  return objects;
}

using Objects = decltype(objects_of(""));

TEST(ObjObjects, AreItsObjectsAndGroups) {
  const std::string face = "f 1 2 3\n";
  EXPECT_EQ(objects_of(face), Objects{});
  EXPECT_EQ(objects_of(face + "o chair\n" + face + face + "o table\n" + face), (Objects{{"chair", -1, 2}, {"table", -1, 1}}));
  EXPECT_EQ(objects_of(face + "g a b\n" + face), (Objects{{"a b", -1, 1}}));
  EXPECT_EQ(objects_of("o house\ng wall\n" + face + "g roof\n" + face + "g wall\n" + face),
            (Objects{{"house", -1, 0}, {"wall", 0, 1}, {"roof", 0, 1}, {"wall.001", 0, 1}}));
  EXPECT_EQ(objects_of("o house\n" + face + "g wall\n" + face + "o house\n" + face),
            (Objects{{"house", -1, 1}, {"wall", 0, 1}, {"house.001", -1, 1}}));
  EXPECT_EQ(objects_of("o nothing\no chair\n" + face + "o\n"), (Objects{{"chair", -1, 1}}));
}

}  // namespace
}  // namespace alvor
