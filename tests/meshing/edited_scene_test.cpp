// The scene that follows from edits, and the steps that hold after undo and redo.

#include "meshing/edit/edited_scene.h"
#include "meshing/base_mesh.h"
#include "meshing/edit/copied_objects.h"
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

TEST(EditedScene, ObjectsGrowAboutTheirMiddleAndTurnAboutAnyAxis) {
  const Scene scene = lamps();
  const Scene edited = edited_scene(
      scene, std::vector<SceneEdit>{ObjectEdit{.name = "stand", .turn = 90, .turn_axis = Vec3{0, 0, -4}, .scale = 3}});
  EXPECT_FALSE(find_fault(edited));
  const std::size_t left = scene.objects[1].first_face;
  const auto before = corners_of(scene, left), after = corners_of(edited, left);
  for (std::size_t c = 0; c < 4; ++c) {
    const Vec3 middle{1.25, 2.9, 1.25}, from = before[c] - middle;  // seen from -z, x goes to -y
    EXPECT_LT(length(after[c] - (middle + 3 * Vec3{from.y, -from.x, from.z})), 1e-12);
  }
  const BaseMesh submitted(scene), mesh = submitted.edited_as(edited);
  for (std::uint32_t root = 0; root < mesh.roots().size(); ++root) {
    const bool is_of_stand = edited.objects[1].first_face <= mesh.roots()[root].input.first &&
                             mesh.roots()[root].input.first < edited.objects[1].first_face + 2;
    EXPECT_NEAR(mesh.roots()[root].area, (is_of_stand ? 9 : 1) * submitted.roots()[root].area, 1e-12) << root;
  }
  const auto reason = [&](const ObjectEdit& edit) {
    const auto fault = fault_in(std::vector<SceneEdit>{edit}, scene);
    return fault ? fault->field + ": " + fault->reason : "none";
  };
  EXPECT_EQ(reason({.name = "stand", .scale = 0}), "object.scale: must be in [0.01, 100]");
  EXPECT_EQ(reason({.name = "stand", .scale = std::nan("")}), "object.scale: must be in [0.01, 100]");
  EXPECT_EQ(reason({.name = "stand", .turn_axis = Vec3{0, 0, 1}}), "object.turn_axis: is given without a turn");
  EXPECT_EQ(reason({.name = "stand", .turn = 1, .turn_axis = Vec3{}}), "object.turn_axis: must not be zero");
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

TEST(EditedScene, ACopyIsOneObjectOfAllThatHangsFromTheOtherAndCanBeEdited) {
  const Scene scene = lamps();
  const std::vector<SceneEdit> edits{ObjectCopy{"second stand", "stand"},
                                     ObjectEdit{.name = "second stand", .dim = 0.5, .move = Vec3{0, -1, 0}},
                                     ObjectCopy{"third", "second stand"}};
  ASSERT_FALSE(fault_in(edits, scene));
  const Scene edited = edited_scene(scene, edits);
  EXPECT_FALSE(find_fault(edited));
  ASSERT_EQ(edited.objects.size(), 6u);
  const SceneObject &copy = edited.objects[4], &third = edited.objects[5];
  EXPECT_EQ(copy.copy_of, 0u);
  EXPECT_EQ(third.copy_of, 4u);
  ASSERT_EQ(copy.face_count, 2u);
  ASSERT_EQ(third.face_count, 2u);
  for (std::uint32_t k = 0; k < 2; ++k) {
    const auto of = corners_of(scene, scene.objects[1].first_face + k), moved = corners_of(edited, copy.first_face + k);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_EQ(moved[c], (of[c] + Vec3{0, -1, 0}));
    EXPECT_EQ(corners_of(edited, third.first_face + k), of) << "copies are of what was submitted";
  }
  EXPECT_EQ(edited.materials[edited.faces[copy.first_face].material].emission, 0.5 * scene.materials[1].emission);
  EXPECT_EQ(edited.faces[third.first_face].material, scene.faces[scene.objects[1].first_face].material);
}

TEST(EditedScene, CopiesThatAreTakenBackKeepTheirNumbersAndFreeTheirNames) {
  const Scene scene = lamps();
  const auto copied = [](const char* name, const char* of) {
    return EditStep{EditStep::Kind::edit, {ObjectCopy{name, of}, ObjectEdit{.name = name, .move = Vec3{0, -1, 0}}}};
  };
  const auto after = [&](const std::vector<EditStep>& steps) { return edited_scene(scene, *edits_that_hold(steps)); };
  const Scene first = after({copied("a", "alone"), copied("b", "a")});
  const Scene gone = after({copied("a", "alone"), copied("b", "a"), undo, undo});
  const Scene again = after({copied("a", "alone"), copied("b", "a"), undo, undo, copied("a", "stand")});
  ASSERT_EQ(gone.objects.size(), first.objects.size());
  for (std::size_t n = 4; n < 6; ++n) {
    EXPECT_FALSE(first.objects[n].is_hidden);
    EXPECT_TRUE(gone.objects[n].is_hidden);
    EXPECT_TRUE(again.objects[n].is_hidden);
    EXPECT_EQ(gone.objects[n].first_face, first.objects[n].first_face);
    EXPECT_EQ(again.objects[n].copy_of, first.objects[n].copy_of);
  }
  const auto emission = [](const Scene& of, std::size_t object) {
    return of.materials[of.faces[of.objects[object].first_face].material].emission;
  };
  EXPECT_FALSE(emission(first, 4).is_zero());
  EXPECT_TRUE(emission(gone, 4).is_zero()) << "what was taken back does not shine";
  EXPECT_EQ(again.objects[6].name, "a");
  EXPECT_EQ(again.objects[6].copy_of, 0u);
  EXPECT_FALSE(find_fault(gone));
  EXPECT_FALSE(find_fault(again));
}

TEST(EditedScene, FaultsOfCopiesNameTheirField) {
  const Scene scene = lamps();
  const auto field = [&](const std::vector<SceneEdit>& edits) {
    const auto fault = fault_in(edits, scene);
    return fault ? std::to_string(fault->edit) + " " + fault->field : "";
  };
  EXPECT_EQ(field({ObjectCopy{"", "alone"}}), "0 copy.name");
  EXPECT_EQ(field({ObjectCopy{std::string(1001, 'x'), "alone"}}), "0 copy.name");
  EXPECT_EQ(field({ObjectCopy{"left", "alone"}}), "0 copy.name");
  EXPECT_EQ(field({ObjectCopy{"a", "alone"}, ObjectCopy{"a", "left"}}), "1 copy.name");
  EXPECT_EQ(field({ObjectCopy{"a", "nobody"}}), "0 copy.of");
  EXPECT_EQ(field({ObjectEdit{.name = "a", .dim = 1}}), "0 object.name");
  EXPECT_EQ(field({ObjectEdit{.name = "a", .dim = 1}, ObjectCopy{"a", "alone"}}), "") << "copies are made first";
  Scene with_gone = scene;
  append_copies(with_gone, std::vector<SceneEdit>{ObjectCopy{"a", "alone", true}});
  const std::string gone = with_gone.objects.back().name;
  EXPECT_TRUE(fault_in(std::vector<SceneEdit>{ObjectCopy{"b", gone}}, with_gone)) << gone;
  EXPECT_TRUE(fault_in(std::vector<SceneEdit>{ObjectEdit{.name = gone, .dim = 1}}, with_gone)) << gone;
  EXPECT_FALSE(fault_in(std::vector<SceneEdit>{ObjectCopy{"a", "alone"}}, with_gone)) << "the name is free again";
  std::vector<SceneEdit> many;
  for (int n = 0; n <= 1000; ++n) many.emplace_back(ObjectCopy{std::to_string(n), "alone"});
  EXPECT_EQ(field(many), "1000 copy.name");
  std::vector<SceneEdit> doubled{ObjectCopy{"1", "stand"}};
  for (int n = 1; n < 20; ++n) doubled.push_back(ObjectCopy{std::to_string(n + 1), std::to_string(n)});
  EXPECT_EQ(field(doubled), "") << "each has two faces";
  Scene large = scene;
  large.objects[3].face_count = 1;
  for (int n = 0; n < 60'000; ++n) test::add_polygon(large, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 0);
  large.objects[3].face_count += 60'000;
  const auto fault = fault_in(std::vector<SceneEdit>{ObjectCopy{"a", "alone"}, ObjectCopy{"b", "alone"}}, large);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->edit, 1u);
  EXPECT_EQ(fault->field, "copy.of");
}

TEST(EditedScene, TheMeshHasTheRootsOfCopiesAfterAllOthers) {
  Scene scene = test::coloured_room();
  const auto first = static_cast<std::uint32_t>(scene.faces.size());
  test::add_box(scene, {0.3, 0.1, 3.3}, {0.8, 0.6, 3.8}, false);
  Material sheet = test::grey(0, 0.5);
  sheet.two_sided = true;
  scene.materials.push_back(sheet);
  test::add_polygon(scene, {{3, 0.1, 3.1}, {3, 1, 3.1}, {3, 1, 4}, {3, 0.1, 4}},
                    static_cast<std::uint32_t>(scene.materials.size() - 1));
  scene.objects = {{.name = "things", .first_face = first, .face_count = 7}};
  const BaseMesh submitted(scene);
  const std::vector<SceneEdit> edits{ObjectCopy{"more", "things"}, ObjectEdit{.name = "more", .move = Vec3{0.5, 0.5, 0}}};
  const BaseMesh edited = submitted.edited_as(edited_scene(scene, edits));
  const auto roots = static_cast<std::uint32_t>(submitted.roots().size());
  ASSERT_EQ(edited.roots().size(), roots + 8) << "six sides, a front and a back";
  for (std::uint32_t r = 0; r < roots; ++r) EXPECT_EQ(edited.roots()[r].corners, submitted.roots()[r].corners);
  std::uint32_t neighbours = 0;
  for (std::uint32_t r = roots; r < edited.roots().size(); ++r) {
    const RootPatch& root = edited.roots()[r];
    EXPECT_GE(root.input.first, scene.faces.size());
    for (int e = 0; e < root.corner_count; ++e)
      if (const auto other = edited.across(r, e)) {
        ++neighbours;
        EXPECT_GE(other->root, roots);
        EXPECT_EQ(edited.across(other->root, other->edge)->root, r);
      }
    for (std::uint32_t other = 0; other < roots; ++other)
      for (int c = 0; c < root.corner_count; ++c)
        for (int k = 0; k < 4; ++k) EXPECT_NE(root.vertex[c], submitted.roots()[other].vertex[k]);
  }
  EXPECT_EQ(neighbours, 24u) << "the box is closed";
  const RootPatch& back = edited.roots().back();
  EXPECT_TRUE(back.is_back);
  EXPECT_EQ(back.twin, roots + 6);
  EXPECT_EQ(edited.roots()[back.twin].twin, roots + 7);
}

TEST(EditedScene, LightsGetOtherDistributions) {
  Scene scene = lamps();
  const PhotometricWeb web{.planes = {0}, .angles = {0, 90}, .intensities = {100, 0}};
  Light luminaire{"downlight", LightKind::luminaire, {1, 1, 1}, {1, 2, 1}, {0, -1, 0}};
  luminaire.web = std::make_shared<const PhotometricWeb>(web);
  scene.lights = {{"spot", LightKind::spot, {1, 1, 1}, {1, 2, 1}, {0, -1, 0}}, luminaire};
  ASSERT_FALSE(find_fault(scene));
  const PhotometricWeb wide{.planes = {0}, .angles = {0, 180}, .intensities = {50, 50}};
  const auto after = [&](const std::vector<SceneEdit>& edits) {
    EXPECT_FALSE(fault_in(edits, scene));
    const Scene edited = edited_scene(scene, edits);
    EXPECT_FALSE(find_fault(edited));
    return edited.lights;
  };
  EXPECT_EQ(after({LightEdit{.name = "spot", .cone = ConeAngles{0.1, 0.3}}})[0].outer_cone, 0.3);
  EXPECT_EQ(*after({LightEdit{.name = "downlight", .web = wide}})[1].web, wide);
  // From down to ahead, about x, which is plane 0 and stays; from down to the side plane 0 turns with the aim.
  const Light ahead = after({LightEdit{.name = "downlight", .direction = Vec3{0, 0, -3}}})[1];
  EXPECT_LT(length(ahead.direction - Vec3{0, 0, -1}) + length(ahead.across - Vec3{1, 0, 0}), 1e-12);
  const LightEdit aside{.name = "downlight", .direction = Vec3{1, 0, 0}}, up{.name = "downlight", .direction = Vec3{0, 1, 0}};
  EXPECT_LT(length(after({aside})[1].across - Vec3{0, 1, 0}), 1e-12);
  EXPECT_LT(length(after({up})[1].across - Vec3{1, 0, 0}), 1e-12);
  EXPECT_EQ(after({up, aside})[1], after({aside})[1]) << "whatever edits before it said";
  const auto field = [&](const SceneEdit& edit) {
    const auto fault = fault_in(std::vector{edit}, scene);
    return fault ? fault->field : "";
  };
  EXPECT_EQ(field(LightEdit{.name = "downlight", .cone = ConeAngles{0.1, 0.3}}), "light.cone");
  EXPECT_EQ(field(LightEdit{.name = "spot", .cone = ConeAngles{0.4, 0.3}}), "light.cone");
  EXPECT_EQ(field(LightEdit{.name = "spot", .cone = ConeAngles{0, std::nan("")}}), "light.cone");
  EXPECT_EQ(field(LightEdit{.name = "spot", .web = wide}), "light.web");
  EXPECT_EQ(field(LightEdit{.name = "downlight", .web = PhotometricWeb{}}), "light.web");
}

TEST(EditedScene, TheMediumIsWhatTheNewestEditSays) {
  const Scene scene = lamps();
  const std::vector<SceneEdit> edits{MediumEdit{{1, 1, 1}}, MediumEdit{{0.1, 0.2, 0}}};
  ASSERT_FALSE(fault_in(edits, scene));
  EXPECT_EQ(edited_scene(scene, edits).absorption, (Rgb{0.1, 0.2, 0}));
  for (const double bad : {-1.0, std::nan(""), 1e7}) {
    const auto fault = fault_in(std::vector<SceneEdit>{MediumEdit{{bad, 0, 0}}}, scene);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->field, "medium.absorption_per_meter");
  }
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
           MaterialEdit{.name = "m0", .diffuse_transmittance = Rgb{0.1, 0, 0}},
           MaterialEdit{.name = "m0", .regular_transmittance = Rgb{0.1, 0, 1.1}}, LightEdit{.name = "sun", .dim = 1},
           DaylightEdit{{.sun = SunPosition{0, 100}}}}) {
    const auto fault = fault_in(std::vector{good, bad}, scene);
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->edit, 1u);
  }
}

TEST(EditedScene, WhatHasNoFacesCannotBeHiddenOrDimmedAsAnObject) {
  Scene scene = lamps();
  const auto at = static_cast<std::uint32_t>(scene.objects.size());
  scene.objects.push_back({.name = "bulb"});
  scene.objects.push_back({.name = "group"});
  scene.objects.push_back({.name = "box", .parent = at + 1, .first_face = 0, .face_count = 1});
  scene.objects[0].face_count = 0;
  scene.lights = {{"bulb", LightKind::point, {1, 1, 1}, {1, 2, 1}}};
  const auto reason = [&](const SceneEdit& edit) {
    const auto fault = fault_in(std::vector{edit}, scene);
    return fault ? fault->reason : "";
  };
  EXPECT_EQ(reason(ObjectEdit{.name = "bulb", .hidden = true}), "'bulb' has no faces: edit it as a light");
  EXPECT_EQ(reason(ObjectEdit{.name = "bulb", .dim = 0}), "'bulb' has no faces: edit it as a light");
  EXPECT_EQ(reason(ObjectEdit{.name = "group", .hidden = true}), "") << "what hangs from it has faces";
}

TEST(EditedScene, UnknownNamesAreAnsweredWithThoseThatThereAre) {
  Scene scene = lamps();
  const auto reason = [&](const SceneEdit& edit) { return fault_in(std::vector{edit}, scene)->reason; };
  EXPECT_EQ(reason(LightEdit{.name = "bulp", .dim = 1}), "'bulp' is no light of the scene");
  scene.lights = {{"bulb", LightKind::point, {1, 1, 1}, {1, 2, 1}}};
  EXPECT_EQ(reason(LightEdit{.name = "bulp", .dim = 1}), "'bulp' is no light of the scene; there is 'bulb'");
  for (int n = 1; n < 10; ++n) scene.lights.push_back({"lamp " + std::to_string(n), LightKind::point, {1, 1, 1}, {1, 2, 1}});
  scene.lights[1].is_hidden = true;
  scene.lights[2].name = std::string(1000, 'x');
  const std::string text = reason(LightEdit{.name = "bulp", .dim = 1});
  EXPECT_NE(text.find("'bulb', 'lamp 3'"), std::string::npos) << text;
  EXPECT_LT(text.size(), 200u);
  EXPECT_NE(text.find("and 1 more"), std::string::npos) << text;
}

}  // namespace
}  // namespace alvor
