// Scenes whose faces edits add to another scene, as objects.

#include "meshing/base_mesh.h"
#include "meshing/edit/copied_objects.h"
#include "meshing/edit/edited_scene.h"
#include "tests/scenes.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace alvor {
namespace {

/// A box whose base lies in the plane y = 0, and a sheet of two sides that emits, in a scene where y points up.
Scene box_and_sheet() {
  Scene scene;
  scene.materials = {test::grey(0, 0.5), test::grey(3, 0.2)};
  scene.materials[1].two_sided = true;
  scene.materials[0].name = "wood", scene.materials[1].name = "glow";
  test::add_box(scene, {0, 0, 0}, {1, 2, 3}, false);
  test::add_polygon(scene, {{0, 2.5, 0}, {1, 2.5, 0}, {1, 2.5, 1}, {0, 2.5, 1}}, 1);
  return scene;
}

AddedScenes scenes(Scene scene) { return {{"scenes/thing", std::make_shared<const Scene>(std::move(scene))}}; }

AddedMeshes meshes_of(const AddedScenes& scenes) {
  AddedMeshes meshes;
  for (const auto& [name, scene] : scenes) meshes[name] = std::make_shared<const BaseMesh>(*scene);
  return meshes;
}

ObjectCopy thing(const std::string& name, bool is_taken_back = false) {
  return {.name = name, .of = "", .is_taken_back = is_taken_back, .scene = "scenes/thing"};
}

TEST(AddedScene, IsAnObjectOfItsFacesAndMaterialsAfterAllOthers) {
  const Scene room = test::room_of_objects();
  const AddedScenes added = scenes(box_and_sheet());
  const std::vector<SceneEdit> edits{thing("thing"), ObjectEdit{.name = "thing", .move = Vec3{0, 0, 1}},
                                     MaterialEdit{.name = room.materials[0].name, .reflectance = Rgb{0.1, 0.1, 0.1}}};
  ASSERT_FALSE(fault_in(edits, room, added));
  const Scene edited = edited_scene(room, edits, added);
  ASSERT_FALSE(find_fault(edited)) << find_fault(edited)->text();
  ASSERT_EQ(edited.objects.size(), room.objects.size() + 1);
  const SceneObject& object = edited.objects.back();
  EXPECT_EQ(object.from_scene, "scenes/thing");
  EXPECT_EQ(object.first_face, room.faces.size());
  EXPECT_EQ(object.face_count, 7u);
  ASSERT_EQ(edited.materials.size(), room.materials.size() + 2);
  EXPECT_EQ(edited.materials.back().name, "glow of thing");
  EXPECT_EQ(edited.faces.back().material, edited.materials.size() - 1);

  const BaseMesh submitted(room), mesh = submitted.edited_as(edited, meshes_of(added));
  const auto roots = static_cast<std::uint32_t>(submitted.roots().size());
  ASSERT_EQ(mesh.roots().size(), roots + 8) << "six sides, a front and a back";
  for (std::uint32_t r = 0; r < roots; ++r) EXPECT_EQ(mesh.roots()[r].corners, submitted.roots()[r].corners);
  std::uint32_t neighbours = 0;
  for (std::uint32_t r = roots; r < mesh.roots().size(); ++r)
    for (int e = 0; e < mesh.roots()[r].corner_count; ++e)
      if (const auto other = mesh.across(r, e)) {
        ++neighbours;
        EXPECT_EQ(mesh.across(other->root, other->edge)->root, r);
      }
  EXPECT_EQ(neighbours, 24u) << "the box is closed";
  EXPECT_EQ(mesh.roots()[roots + 7].twin, roots + 6);
  EXPECT_EQ(mesh.material_of(roots + 7).emission, (Rgb{3, 3, 3}));
  EXPECT_EQ(mesh.roots()[roots + 6].corners[0].z, 1) << "moved";
}

TEST(AddedScene, StandsUprightWhateverPointsUpInIt) {
  for (const UpAxis up : {UpAxis::y, UpAxis::z})
    for (const UpAxis other : {UpAxis::y, UpAxis::z}) {
      Scene room = test::room_of_objects(), upright = box_and_sheet();
      room.up = up, upright.up = other;
      const AddedScenes added = scenes(upright);
      const Scene edited = edited_scene(room, std::vector<SceneEdit>{thing("thing")}, added);
      const auto height = [&](Vec3 p, UpAxis axis) { return axis == UpAxis::y ? p.y : p.z; };
      for (std::size_t v = 0; v < upright.vertices.size(); ++v)
        EXPECT_EQ(height(edited.vertices[room.vertices.size() + v], up), height(upright.vertices[v], other));
      const BaseMesh mesh = BaseMesh(room).edited_as(edited, meshes_of(added));
      for (const RootPatch& root : mesh.roots()) {
        if (root.input.first < room.faces.size()) continue;
        const auto corners = edited.corners_of(edited.faces[root.input.first]);
        EXPECT_EQ(root.corners[0], edited.vertices[corners[0]]);
        EXPECT_GT(dot(root.normal, cross(root.corners[1] - root.corners[0], root.corners[2] - root.corners[0])), 0);
      }
    }
}

TEST(AddedScene, MayHaveTexturesAndColoursWhereTheOtherHasNone) {
  const Scene room = test::room_of_objects();
  Scene coloured;
  coloured.materials = {test::grey(0, 0.5)};
  coloured.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}};
  const RgbF red{1, 0, 0};
  coloured.add_face(std::vector<std::uint32_t>{0, 1, 2}, 0, {}, std::vector<RgbF>{red, red, red});
  const auto image = std::make_shared<ColourImage>();
  image->columns = image->rows = 1;
  image->texels = {10, 20, 30};
  coloured.materials[0].texture = Texture{.image = image};
  coloured.texture_points = {{0, 0}, {1, 0}, {0.5, 1}};
  ASSERT_FALSE(find_fault(coloured)) << find_fault(coloured)->text();
  const AddedScenes added = scenes(coloured);
  const Scene edited = edited_scene(room, std::vector<SceneEdit>{thing("first"), thing("second")}, added);
  ASSERT_FALSE(find_fault(edited)) << find_fault(edited)->text();
  const BaseMesh mesh = BaseMesh(room).edited_as(edited, meshes_of(added));
  const auto last = static_cast<std::uint32_t>(mesh.roots().size()) - 1;
  for (const std::uint32_t root : {last - 1, last}) {
    EXPECT_EQ(mesh.texture_points(root)[2], (TexturePoint{0.5, 1}));
    EXPECT_EQ(mesh.corner_colours(root)[1], red);
  }
  EXPECT_EQ(mesh.corner_colours(0)[0], (RgbF{1, 1, 1}));
  EXPECT_EQ(mesh.texture_points(0)[0], (TexturePoint{0, 0}));
}

TEST(AddedScene, CanBeCopiedAndTakenBack) {
  const Scene room = test::room_of_objects();
  const AddedScenes added = scenes(box_and_sheet());
  const EditStep first{.edits = {thing("thing")}}, second{.edits = {ObjectCopy{"another", "thing"}}};
  const EditStep undo{.kind = EditStep::Kind::undo, .edits = {}};
  const std::vector<EditStep> steps{first, second, undo};
  const Scene edited = edited_scene(room, *edits_that_hold(steps), added);
  ASSERT_EQ(edited.objects.size(), room.objects.size() + 2);
  EXPECT_FALSE(edited.objects[room.objects.size()].is_hidden);
  EXPECT_TRUE(edited.objects.back().is_hidden);
  EXPECT_TRUE(is_taken_back(edited.objects.back()));
  const BaseMesh submitted(room), mesh = submitted.edited_as(edited, meshes_of(added));
  ASSERT_EQ(mesh.roots().size(), submitted.roots().size() + 16);
  EXPECT_TRUE(mesh.roots().back().is_hidden);
  EXPECT_FALSE(mesh.roots()[submitted.roots().size()].is_hidden);
  EXPECT_FALSE(find_fault(edited));
}

TEST(AddedScene, ThatWasTakenBackHasNoPlaceAndLeavesItsNames) {
  const Scene room = test::room_of_objects();
  Scene elsewhere = box_and_sheet();  // its file has it beside the room
  for (Vec3& vertex : elsewhere.vertices) vertex = vertex + Vec3{30, 0, 0};
  const AddedScenes added = scenes(elsewhere);
  const EditStep add{.edits = {thing("thing"), ObjectEdit{.name = "thing", .move = Vec3{-28, 0, 1}}}};
  const EditStep undo{.kind = EditStep::Kind::undo, .edits = {}};
  const auto after = [&](const std::vector<EditStep>& steps) { return edited_scene(room, *edits_that_hold(steps), added); };
  const BaseMesh submitted(room);
  for (const std::vector<EditStep>& steps : {std::vector{add}, std::vector{add, undo}, std::vector{add, undo, add}}) {
    const Scene edited = after(steps);
    EXPECT_FALSE(find_fault(edited));
    EXPECT_FALSE(object_too_far(room, edited));
    const BaseMesh mesh = submitted.edited_as(edited, meshes_of(added));
    EXPECT_EQ(mesh.centre(), submitted.centre());
    EXPECT_EQ(mesh.extent(), submitted.extent());
  }
  const Scene again = after({add, undo, add});
  EXPECT_EQ(again.materials[room.materials.size()].name,
            "wood of thing (taken back " + std::to_string(room.objects.size()) + ")");
  EXPECT_EQ(again.materials[room.materials.size() + 3].name, "glow of thing");
  EXPECT_EQ(again.faces[again.objects.back().first_face].material, room.materials.size() + 2);
}

TEST(AddedScene, BringsOnlyTheVerticesThatItsFacesUse) {
  const Scene room = test::room_of_objects();
  Scene sparse = box_and_sheet();
  sparse.vertices.insert(sparse.vertices.begin(), 100'000, Vec3{7, 7, 7});
  for (std::uint32_t& corner : sparse.corners) corner += 100'000;
  const Scene edited = edited_scene(room, std::vector<SceneEdit>{thing("thing")}, scenes(sparse));
  EXPECT_EQ(edited.vertices.size(), room.vertices.size() + box_and_sheet().vertices.size());
}

TEST(AddedScene, MayHaveATextureThatNoFaceShows) {
  const auto image = std::make_shared<ColourImage>();
  image->columns = image->rows = 1;
  image->texels = {10, 20, 30};
  Scene unused = box_and_sheet();
  unused.materials.push_back(test::grey(0, 0.5));
  unused.materials.back().texture = Texture{.image = image};
  unused.texture_points.resize(unused.corners.size());
  ASSERT_FALSE(find_fault(unused));
  const Scene edited = edited_scene(test::room_of_objects(), std::vector<SceneEdit>{thing("thing")}, scenes(unused));
  EXPECT_FALSE(find_fault(edited)) << find_fault(edited)->text();
}

TEST(AddedScene, FaultsNameTheirField) {
  const Scene room = test::room_of_objects();
  const auto fault = [&](const ObjectCopy& copy, Scene scene) {
    const auto found = fault_in(std::vector<SceneEdit>{copy}, room, scenes(std::move(scene)));
    return found ? found->field + ": " + found->reason : "";
  };
  EXPECT_EQ(fault(thing("thing"), box_and_sheet()), "");
  EXPECT_EQ(fault({.name = "a", .of = "", .scene = "scenes/other"}, box_and_sheet()), "copy.scene: 'scenes/other' is no scene");
  EXPECT_EQ(fault({.name = "a", .of = "box", .scene = "scenes/thing"}, box_and_sheet()),
            "copy.scene: is given, and so is copy.of");
  EXPECT_EQ(fault(thing("box"), box_and_sheet()), "copy.name: there is an object 'box'");
  Scene lit = box_and_sheet();
  lit.lights = {Light{"sun", LightKind::directional, {1, 1, 1}}};
  EXPECT_NE(fault(thing("thing"), lit).find("copy.scene: 'scenes/thing' has light 'sun'"), std::string::npos);
  lit.lights = {Light{"bulb", LightKind::point, {1, 1, 1}}, Light{"bulb", LightKind::point, {1, 1, 1}}};
  EXPECT_NE(fault(thing("thing"), lit).find("a light whose name would be 'bulb of thing'"), std::string::npos);
  lit.lights.clear();
  for (int n = 0; n < 1001; ++n) lit.lights.push_back({std::to_string(n), LightKind::point, {1, 1, 1}});
  EXPECT_NE(fault(thing("thing"), lit).find("too many lights"), std::string::npos);
  lit.lights.resize(501);
  EXPECT_EQ(fault(thing("thing"), lit), "");
  const auto twice = fault_in(std::vector<SceneEdit>{thing("thing"), ObjectCopy{"again", "thing"}}, room, scenes(lit));
  ASSERT_TRUE(twice);
  EXPECT_EQ(twice->edit, 1u);
  EXPECT_NE(twice->reason.find("too many lights"), std::string::npos);
  lit.lights = {Light{std::string(600, 'n'), LightKind::point, {1, 1, 1}}};
  EXPECT_NE(fault(thing(std::string(600, 'o')), lit).find("longer than 1000 bytes"), std::string::npos);
  Scene large = box_and_sheet();
  for (int n = 0; n < 100'000; ++n) test::add_polygon(large, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, 0);
  EXPECT_NE(fault(thing("thing"), large).find("copy.scene: added objects"), std::string::npos);
  Scene round = box_and_sheet();
  round.add_face(std::vector<std::uint32_t>(900'000, 0), 0);
  EXPECT_NE(fault(thing("thing"), round).find("has too many corners"), std::string::npos);
  round.corners.resize(round.corners.size() - 400'000);
  round.faces.back().corner_count = 500'000;
  const auto copied = fault_in(std::vector<SceneEdit>{thing("thing"), ObjectCopy{"again", "thing"}}, room, scenes(round));
  ASSERT_TRUE(copied);
  EXPECT_EQ(copied->edit, 1u);
  EXPECT_NE(copied->reason.find("has too many corners"), std::string::npos);
  Scene motley = box_and_sheet();
  motley.materials.resize(10'001, motley.materials[0]);
  EXPECT_NE(fault(thing("thing"), motley).find("has too many materials"), std::string::npos);
  Scene same = box_and_sheet();
  same.materials[0].name = "x";
  Scene named = room;
  named.materials[0].name = "x of thing";
  const auto taken = fault_in(std::vector<SceneEdit>{thing("thing")}, named, scenes(same));
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->field, "copy.scene");
}

/// A box with a spot above it that shines down, in a scene where z points up.
Scene box_with_spot() {
  Scene scene;
  scene.up = UpAxis::z;
  scene.materials = {test::grey(0, 0.5)};
  test::add_box(scene, {0, 0, 0}, {1, 1, 1}, false);
  Light spot{"spot", LightKind::spot, {2, 3, 4}, {0.25, 0.5, 3}};
  spot.direction = {0, 0, -1};
  spot.radius = 0.1;
  scene.lights = {spot};
  return scene;
}

void expect_near(Vec3 a, Vec3 b) { EXPECT_LT(length(a - b), 1e-12) << a.x << ' ' << a.y << ' ' << a.z; }

TEST(AddedScene, BringsItsLampsWhichGoWithTheObject) {
  Scene room = test::room_of_objects();  // y points up
  room.lights = {Light{"bulb", LightKind::point, {1, 1, 1}, {1, 2, 1}}};
  const AddedScenes added = scenes(box_with_spot());
  const auto light_after = [&](std::vector<SceneEdit> edits) {
    edits.insert(edits.begin(), thing("thing"));
    EXPECT_FALSE(fault_in(edits, room, added));
    const Scene edited = edited_scene(room, edits, added);
    EXPECT_FALSE(find_fault(edited));
    EXPECT_EQ(edited.lights.size(), 2u);
    EXPECT_EQ(edited.lights[0], room.lights[0]);
    EXPECT_EQ(edited.lights[1].name, "spot of thing");
    return edited.lights[1];
  };
  const Light upright = light_after({});
  expect_near(upright.position, {0.25, 3, -0.5});
  expect_near(upright.direction, {0, -1, 0});
  EXPECT_EQ(upright.intensity, (Rgb{2, 3, 4}));

  expect_near(light_after({ObjectEdit{.name = "thing", .move = Vec3{1, 0, 2}}}).position, {1.25, 3, 1.5});
  // A quarter turn about the box's middle, (0.5, 0.5, -0.5), and about x: what was up is at the front.
  const Light turned = light_after({ObjectEdit{.name = "thing", .turn = 90, .turn_axis = Vec3{1, 0, 0}}});
  expect_near(turned.position, {0.25, 0.5, 2});
  expect_near(turned.direction, {0, 0, -1});
  const Light small = light_after({ObjectEdit{.name = "thing", .scale = 0.5}});
  expect_near(small.position, {0.375, 1.75, -0.5});
  EXPECT_EQ(small.radius, 0.05);
  EXPECT_EQ(small.intensity, upright.intensity);
  EXPECT_EQ(light_after({ObjectEdit{.name = "thing", .dim = 0.5}}).intensity, (Rgb{1, 1.5, 2}));
  EXPECT_TRUE(light_after({ObjectEdit{.name = "thing", .hidden = true}}).intensity.is_zero());

  const Light placed = light_after({ObjectEdit{.name = "thing", .move = Vec3{1, 0, 2}},
                                    LightEdit{.name = "spot of thing", .dim = 2, .position = Vec3{1, 1, 1}}});
  expect_near(placed.position, {1, 1, 1});
  EXPECT_EQ(placed.intensity, (Rgb{4, 6, 8}));
  const Light aimed = light_after({LightEdit{.name = "spot of thing", .direction = Vec3{1, 0, 0}},
                                   ObjectEdit{.name = "thing", .move = Vec3{1, 0, 2}, .turn = 90}});
  expect_near(aimed.direction, {1, 0, 0});
  expect_near(light_after({DaylightEdit{Daylight{}}}).position, upright.position);
}

// Names that are the same as that of a lamp which was taken back must not make another one dark.
TEST(AddedScene, LampsThatWereTakenBackAreDarkWhateverOthersAreCalled) {
  Scene room = test::room_of_objects();
  Light sun{"sun", LightKind::directional, {1, 1, 1}};
  const std::string name = "spot of thing (taken back " + std::to_string(room.objects.size()) + ")";
  room.lights = {sun, Light{name, LightKind::point, {5, 5, 5}, {1, 1, 1}}};
  const EditStep add{.edits = {thing("thing")}}, undo{.kind = EditStep::Kind::undo, .edits = {}};
  const EditStep daylight{.edits = {DaylightEdit{Daylight{.sun = SunPosition{.azimuth = 10, .elevation = 30}}}}};
  for (const bool has_daylight : {false, true}) {
    std::vector<EditStep> steps{add, undo, add};
    if (has_daylight) steps.insert(steps.end(), {daylight, daylight});
    const Scene edited = edited_scene(room, *edits_that_hold(steps), scenes(box_with_spot()));
    std::vector<std::pair<std::string, bool>> lights;
    for (const Light& light : edited.lights)
      if (!light.is_distant()) lights.emplace_back(light.name, light.intensity.is_zero());
    EXPECT_EQ(lights, (std::vector<std::pair<std::string, bool>>{{name, false}, {name, true}, {"spot of thing", false}}));
  }
}

TEST(AddedScene, EmitsInTheQuantityOfTheOther) {
  for (const Quantity of_room : {Quantity::radiometric, Quantity::photometric})
    for (const Quantity of_thing : {Quantity::radiometric, Quantity::photometric}) {
      Scene room = test::room_of_objects(), other = box_and_sheet();
      room.quantity = of_room, other.quantity = of_thing;
      other.lights = {Light{"bulb", LightKind::point, {1, 2, 3}}};
      const Scene edited = edited_scene(room, std::vector<SceneEdit>{thing("thing")}, scenes(other));
      EXPECT_EQ(edited.quantity, of_room);
      const double factor = of_room == of_thing ? 1 : of_room == Quantity::photometric ? 179 : 1 / 179.0;
      EXPECT_EQ(edited.materials.back().emission, factor * other.materials.back().emission);
      EXPECT_EQ(edited.lights.back().intensity, factor * other.lights.back().intensity);
    }
}

TEST(AddedScene, LampsAreCopiedAndTakenBackWithTheirObject) {
  const Scene room = test::room_of_objects();
  const AddedScenes added = scenes(box_with_spot());
  const EditStep first{.edits = {thing("thing")}};
  const EditStep second{.edits = {ObjectCopy{"another", "thing"}, ObjectEdit{.name = "another", .move = Vec3{1, 0, 0}}}};
  const EditStep undo{.kind = EditStep::Kind::undo, .edits = {}};
  const auto after = [&](const std::vector<EditStep>& steps) {
    return edited_scene(room, *edits_that_hold(steps), added).lights;
  };
  const auto both = after({first, second});
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[1].name, "spot of another");
  expect_near(both[1].position, both[0].position + Vec3{1, 0, 0});
  EXPECT_EQ(both[1].intensity, both[0].intensity);
  const auto one = after({first, second, undo});
  ASSERT_EQ(one.size(), 2u) << "numbers of lights stay";
  EXPECT_FALSE(one[0].intensity.is_zero());
  EXPECT_TRUE(one[1].intensity.is_zero());
  EXPECT_TRUE(one[1].is_hidden);
  EXPECT_FALSE(one[0].is_hidden);
  const EditStep dim{.edits = {LightEdit{.name = one[1].name, .dim = 2}}};
  Scene taken_back = room;
  append_copies(taken_back, *edits_that_hold(std::vector{first, second, undo}), added);
  EXPECT_TRUE(fault_in(dim.edits, taken_back, added)) << "it is not there";
  const auto again = after({first, undo, first});
  ASSERT_EQ(again.size(), 2u);
  EXPECT_TRUE(again[0].intensity.is_zero());
  EXPECT_EQ(again[1].name, "spot of thing");
}

TEST(AddedScene, MayNotLieFarFromTheOther) {
  const Scene room = test::room_of_objects();
  Scene far = box_and_sheet();
  for (Vec3& vertex : far.vertices) vertex = vertex + Vec3{1000, 0, 0};
  const AddedScenes added = scenes(far);
  const std::vector<SceneEdit> edits{thing("thing")};
  EXPECT_EQ(object_too_far(room, edited_scene(room, edits, added)), "thing");
}

}  // namespace
}  // namespace alvor
