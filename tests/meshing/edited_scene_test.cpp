// The scene that follows from edits, and the steps that hold after undo and redo.

#include "meshing/edit/edited_scene.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace alvor {
namespace {

EditStep step_with(double dim) { return {EditStep::Kind::edit, {ObjectEdit{.name = "o", .dim = dim}}}; }
const EditStep undo{EditStep::Kind::undo, {}}, redo{EditStep::Kind::redo, {}};

std::vector<double> dims_after(const std::vector<EditStep>& steps) {
  const auto hold = edits_that_hold(steps);
  EXPECT_TRUE(hold);
  std::vector<double> dims;
  for (const SceneEdit& edit : hold.value_or(std::vector<SceneEdit>())) dims.push_back(*std::get<ObjectEdit>(edit).dim);
  return dims;
}

TEST(EditSteps, UndoTakesBackTheNewestThatHoldsAndRedoRepeatsIt) {
  EXPECT_EQ(dims_after({step_with(1), step_with(2)}), (std::vector<double>{1, 2}));
  EXPECT_EQ(dims_after({step_with(1), step_with(2), undo}), (std::vector<double>{1}));
  EXPECT_EQ(dims_after({step_with(1), step_with(2), undo, undo}), (std::vector<double>{}));
  EXPECT_EQ(dims_after({step_with(1), step_with(2), undo, undo, redo}), (std::vector<double>{1}));
  EXPECT_EQ(dims_after({step_with(1), step_with(2), undo, step_with(3), undo}), (std::vector<double>{1}));
}

TEST(EditSteps, NothingIsTakenBackOrRepeatedThatIsNotThere) {
  EXPECT_FALSE(edits_that_hold(std::vector{undo}));
  EXPECT_FALSE(edits_that_hold(std::vector{step_with(1), redo}));
  EXPECT_FALSE(edits_that_hold(std::vector{step_with(1), undo, step_with(2), redo}));
}

/// Returns a room of which a stand holds two lamps of one material, and a third lamp stands alone.
Scene lamps() {
  Scene scene = test::coloured_room();
  for (std::size_t n = 0; n < scene.materials.size(); ++n) scene.materials[n].name = "m" + std::to_string(n);
  const auto first = static_cast<std::uint32_t>(scene.faces.size());
  for (const double x : {0.5, 1.5, 2.5})
    test::add_polygon(scene, {{x, 2.9, 1}, {x + 0.5, 2.9, 1}, {x + 0.5, 2.9, 1.5}, {x, 2.9, 1.5}}, 1);
  scene.objects = {{.name = "stand", .first_face = first},
                   {.name = "left", .parent = 0, .first_face = first, .face_count = 1},
                   {.name = "right", .parent = 0, .first_face = first + 1, .face_count = 1},
                   {.name = "alone", .first_face = first + 2, .face_count = 1}};
  EXPECT_FALSE(find_fault(scene));
  return scene;
}

TEST(EditedScene, ObjectsPassTheirDimOnAndShareNoMaterialThen) {
  const Scene scene = lamps();
  const std::vector<SceneEdit> edits{ObjectEdit{.name = "stand", .dim = 0.5}, ObjectEdit{.name = "right", .dim = 0.5}};
  ASSERT_FALSE(fault_in(edits, scene));
  const Scene edited = edited_scene(scene, edits);
  EXPECT_FALSE(find_fault(edited));
  const auto emission = [](const Scene& of, std::size_t face) { return of.materials[of.faces[face].material].emission; };
  const std::size_t left = scene.objects[1].first_face;
  EXPECT_EQ(emission(edited, left), 0.5 * emission(scene, left));
  EXPECT_EQ(emission(edited, left + 1), 0.25 * emission(scene, left));
  EXPECT_EQ(emission(edited, left + 2), emission(scene, left));
  EXPECT_EQ(edited.materials.size(), scene.materials.size() + 2);
  EXPECT_EQ(edited.materials.back().name, "m1 of right");
}

TEST(EditedScene, WhatIsMultipliedDoesNotDependOnTheOrderOfEdits) {
  const Scene scene = lamps();
  const SceneEdit dim = ObjectEdit{.name = "left", .dim = 0.5}, brighter = MaterialEdit{.name = "m1", .emission = Rgb{8, 8, 8}};
  const std::size_t face = scene.objects[1].first_face;
  for (const auto& edits : {std::vector{dim, brighter}, std::vector{brighter, dim}}) {
    const Scene edited = edited_scene(scene, edits);
    EXPECT_EQ(edited.materials[edited.faces[face].material].emission, (Rgb{4, 4, 4}));
  }
}

TEST(EditedScene, AnEditMadeTwiceIsAsGoodAsOnce) {
  const Scene scene = lamps();
  const SceneEdit dim = ObjectEdit{.name = "left", .dim = 0.5};
  const Scene once = edited_scene(scene, std::vector{dim}), twice = edited_scene(scene, std::vector{dim, dim});
  EXPECT_EQ(once.materials.back().emission, twice.materials.back().emission);
}

std::vector<Vec3> corners_of(const Scene& scene, std::size_t face) {
  std::vector<Vec3> corners;
  for (const std::uint32_t vertex : scene.corners_of(scene.faces[face])) corners.push_back(scene.vertices[vertex]);
  return corners;
}

TEST(EditedScene, ObjectsTurnAboutTheirMiddleAndThenMoveWithThoseThatHangFromThem) {
  const Scene scene = lamps();
  const Scene edited = edited_scene(scene, std::vector<SceneEdit>{ObjectEdit{.name = "stand", .move = Vec3{0, -1, 0}, .turn = 90},
                                                                  ObjectEdit{.name = "right", .move = Vec3{0, 0, 0.25}}});
  EXPECT_FALSE(find_fault(edited));
  const std::size_t left = scene.objects[1].first_face;
  // The stand's lamps lie about (1.25, 2.9, 1.25). Counter-clockwise from above, x goes to -z.
  const auto before = corners_of(scene, left), after = corners_of(edited, left), other = corners_of(edited, left + 1);
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 from = before[c] - Vec3{1.25, 2.9, 1.25};
    EXPECT_LT(length(after[c] - Vec3{1.25 + from.z, 1.9, 1.25 - from.x}), 1e-12);
    const Vec3 moved = corners_of(scene, left + 1)[c] + Vec3{0, 0, 0.25} - Vec3{1.25, 2.9, 1.25};
    EXPECT_LT(length(other[c] - Vec3{1.25 + moved.z, 1.9, 1.25 - moved.x}), 1e-12);
  }
  EXPECT_EQ(corners_of(edited, left + 2), corners_of(scene, left + 2));
  EXPECT_LT(length(edited.objects[1].placement.origin - edited.objects[1].motion.origin), 1e-12);
}

TEST(EditedScene, WhatHangsFromAHiddenObjectIsHiddenAndShinesNoMore) {
  const Scene scene = lamps();
  const Scene edited = edited_scene(
      scene, std::vector<SceneEdit>{ObjectEdit{.name = "stand", .hidden = true}, ObjectEdit{.name = "left", .hidden = false}});
  EXPECT_TRUE(edited.objects[1].is_hidden);
  EXPECT_FALSE(edited.objects[3].is_hidden);
  EXPECT_TRUE(edited.materials[edited.faces[scene.objects[1].first_face].material].emission.is_zero());
}

TEST(EditedScene, DaylightTakesThePlaceOfAllLightFromAfar) {
  Scene scene = lamps();
  scene.north_degrees = 90;
  Light evening{"sun", LightKind::directional, {5, 1, 0}}, moon{"moon", LightKind::directional, {0.1, 0.1, 0.1}};
  scene.lights = {evening, {"bulb", LightKind::point, {1, 1, 1}, {1, 1, 1}}, moon};
  const SceneEdit noon = DaylightEdit{{.sun = SunPosition{0, 60}, .sun_irradiance = 800, .sky = Daylight::Sky::uniform}};
  const SceneEdit dim = LightEdit{.name = "sun", .dim = 0.5}, dim_moon = LightEdit{.name = "moon", .dim = 2};
  const auto after = [&](const std::vector<SceneEdit>& edits) {
    EXPECT_FALSE(fault_in(edits, scene));
    return edited_scene(scene, edits).lights;
  };
  const auto lights = after({dim, dim_moon, noon, dim_moon});
  ASSERT_EQ(lights.size(), 3u);
  EXPECT_EQ(lights[0].name, "bulb");
  EXPECT_EQ(lights[1].name, "sun");
  EXPECT_EQ(lights[1].intensity.g, 800) << "an edit of the sun that was there before";
  EXPECT_LT(length(lights[1].direction - Vec3{-0.5, -std::sqrt(0.75), 0}), 1e-12) << "the scene's north is x";
  EXPECT_EQ(lights[2].name, "sky");
  EXPECT_EQ(after({noon, dim})[1].intensity.g, 400);
  EXPECT_EQ(after({noon, noon}).size(), 3u);
  EXPECT_EQ(after({noon, DaylightEdit{}}).size(), 1u);
}

TEST(EditedScene, TexturesSayHowMuchIsReflected) {
  Scene scene = lamps();
  scene.materials[0].texture.emplace();
  const auto fault = fault_in(std::vector<SceneEdit>{MaterialEdit{.name = "m0", .reflectance = Rgb{0.5, 0.5, 0.5}}}, scene);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->field, "material.reflectance");
}

TEST(EditedScene, FaultsNameTheFirstEditThatCannotBe) {
  const Scene scene = lamps();
  const SceneEdit good = ObjectEdit{.name = "left", .dim = 0.5};
  for (const SceneEdit& bad : std::vector<SceneEdit>{
           ObjectEdit{.name = "middle", .dim = 1}, ObjectEdit{.name = "left", .dim = -1}, ObjectEdit{.name = "left", .dim = NAN},
           ObjectEdit{.name = "left", .dim = {}}, ObjectEdit{.name = "left", .turn = NAN},
           ObjectEdit{.name = "left", .move = Vec3{1e12, 0, 0}}, ObjectEdit{.name = "left", .move = Vec3{0, NAN, 0}},
           ObjectEdit{.name = "left", .move = Vec3{0, 0, -11}}, MaterialEdit{.name = "m0", .emission = Rgb{-1, 0, 0}},
           MaterialEdit{.name = "m0", .reflectance = Rgb{1, 0, 0}},
           MaterialEdit{.name = "m0", .diffuse_transmittance = Rgb{0.1, 0, 0}}, LightEdit{.name = "sun", .dim = 1},
           DaylightEdit{{.sun = SunPosition{0, 100}}}}) {
    const auto fault = fault_in(std::vector{good, bad}, scene);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->edit, 1u);
  }
}

}  // namespace
}  // namespace alvor
