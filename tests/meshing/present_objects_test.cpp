// Tests of PresentObjects and present_scene(): the objects, faces and lights of an edited scene that no edit has hidden.

#include "meshing/present_objects.h"
#include "meshing/edit/present_scene.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

/// Returns a floor that belongs to no object, and four objects of one face each: `b` hangs from `a`, `d` from `c`.
Scene four_shelves() {
  Scene scene;
  scene.materials = {test::grey(1, 0.5)};
  const auto add_square = [&](double y) { test::add_polygon(scene, {{0, y, 0}, {0, y, 1}, {1, y, 1}, {1, y, 0}}, 0); };
  add_square(0);
  for (const char* name : {"a", "b", "c", "d"}) {
    const auto face = static_cast<std::uint32_t>(scene.faces.size());
    scene.objects.push_back({.name = name, .first_face = face, .face_count = 1});
    add_square(face);
  }
  scene.objects[1].parent = 0, scene.objects[3].parent = 2;
  EXPECT_FALSE(find_fault(scene));
  return scene;
}

TEST(PresentObjects, AreNumberedAsIfTheOthersHadNeverBeenThere) {
  Scene scene = four_shelves();
  scene.objects[0].is_hidden = scene.objects[1].is_hidden = true;
  const PresentObjects present(scene.objects);
  ASSERT_EQ(present.objects().size(), 2u);
  EXPECT_EQ(present.objects()[0].name, "c");
  EXPECT_EQ(present.objects()[0].first_face, 1u);
  EXPECT_EQ(present.objects()[1].first_face, 2u);
  EXPECT_EQ(present.objects()[1].parent, 0u);
  for (const std::uint32_t face : {0u, 3u, 4u}) EXPECT_TRUE(present.has(face));
  for (const std::uint32_t face : {1u, 2u}) EXPECT_FALSE(present.has(face));
  EXPECT_EQ(present.number_of(0), 0u);
  EXPECT_EQ(present.number_of(3), 1u);
  EXPECT_EQ(present.number_of(4), 2u);
}

TEST(PresentObjects, OfPairsOfFacesOneMayBeMissing) {
  Scene scene = four_shelves();
  scene.objects[3].is_hidden = true;
  EXPECT_EQ(PresentObjects(scene.objects).numbers_of({3, 4}), (InputFaces{3, InputFaces::none}));
  EXPECT_EQ(PresentObjects(scene.objects).numbers_of({2, 3}), (InputFaces{2, 3}));
}

TEST(PresentScene, HasTheFacesAndVerticesThatAreThere) {
  Scene scene = four_shelves();
  scene.objects[2].is_hidden = scene.objects[3].is_hidden = true;
  scene.lights.emplace_back().is_hidden = true;
  scene.lights.emplace_back().name = "bulb";
  const Scene here = present_scene(scene);
  EXPECT_EQ(here.faces.size(), 3u);
  EXPECT_EQ(here.vertices.size(), 12u);
  EXPECT_EQ(here.objects.size(), 2u);
  ASSERT_EQ(here.lights.size(), 1u);
  EXPECT_EQ(here.lights[0].name, "bulb");
  for (std::uint32_t f = 0; f < 3; ++f)
    for (std::uint32_t k = 0; k < 4; ++k)
      EXPECT_EQ(here.vertices[here.corners_of(here.faces[f])[k]], scene.vertices[scene.corners_of(scene.faces[f])[k]]);
}

TEST(PresentScene, KeepsItsTexturePointsWhereNoTexturedFaceIsLeft) {
  Scene scene = four_shelves();
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].texture.emplace();
  scene.faces[1].material = 1;
  scene.texture_points.resize(scene.corners.size());
  scene.objects[0].is_hidden = scene.objects[1].is_hidden = true;
  EXPECT_EQ(present_scene(scene).texture_points.size(), 12u);
}

}  // namespace
}  // namespace alvor
