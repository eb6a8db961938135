// EditSolve of objects: dimmed, moved, taken away and added.

#include "tests/server/editing.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace alvor {
namespace {

using test::EditingTest, test::copied, test::mean, test::moved, test::room, test::undo;

TEST_F(EditingTest, ObjectsOfOneMaterialAreDimmedByThemselves) {
  v1::EditStep step;
  step.add_edits()->mutable_object()->set_name("lamp.1");
  step.mutable_edits(0)->mutable_object()->set_dim(0);
  client.edit_solve(solve, step);
  const Scene edited = client.read_scene(solve);
  const auto emission_of = [&](const std::string& object) {
    const auto it = std::ranges::find(edited.objects, object, &SceneObject::name);
    return edited.materials[edited.faces[it->first_face].material].emission;
  };
  EXPECT_EQ(emission_of("lamp.0"), room().materials[1].emission);
  EXPECT_TRUE(emission_of("lamp.1").is_zero());
  end();
  EXPECT_EQ(last.state(), v1::Solve::SUCCEEDED);
}

TEST_F(EditingTest, ObjectsAreMovedAndTakenAway) {
  const std::size_t roots = BaseMesh(room()).roots().size();
  v1::EditStep step = moved("lamp.0", 1, -0.5, 2);
  step.add_edits()->mutable_object()->set_name("lamp.1");
  step.mutable_edits(1)->mutable_object()->set_hidden(true);
  client.edit_solve(solve, step);
  const Scene edited = client.read_scene(solve);
  const auto corner = [](const Scene& scene, std::size_t face) { return scene.vertices[scene.corners_of(scene.faces[face])[0]]; };
  const std::size_t lamp = room().objects[0].first_face;
  EXPECT_EQ(corner(edited, lamp), corner(room(), lamp) + (Vec3{1, -0.5, 2}));
  EXPECT_EQ(edited.objects[0].motion.origin, (Vec3{1, -0.5, 2}));
  EXPECT_TRUE(edited.objects[1].is_hidden);
  const auto leaves = end();
  EXPECT_EQ(last.state(), v1::Solve::SUCCEEDED);
  for (const LeafValue& leaf : leaves) {
    if (leaf.patch.root_face() != roots - 1) continue;
    EXPECT_TRUE(leaf.irradiance.is_zero());
  }
  try {
    client.create_scene(edited, "");
    ADD_FAILURE() << "a scene with a hidden object was taken";
  } catch (const RpcError& error) {
    EXPECT_NE(std::string(error.what()).find("INVALID_ARGUMENT: object 'lamp.1': is hidden"), std::string::npos) << error.what();
  }
}

TEST_F(EditingTest, ObjectsAreAddedAsCopiesAndTakenBack) {
  const std::size_t leaves = end().size(), roots = BaseMesh(room()).roots().size();
  client.edit_solve(solve, copied("lamp.2", "lamp.0", 1, -1, 1));
  const auto with = end();
  EXPECT_GE(with.size(), leaves / 2);
  EXPECT_EQ(with.back().patch.root_face(), roots);
  const Scene edited = client.read_scene(solve);
  ASSERT_EQ(edited.objects.size(), room().objects.size() + 1);
  EXPECT_EQ(edited.objects.back().name, "lamp.2");
  EXPECT_EQ(edited.faces.size(), room().faces.size() + 1);
  const BaseMesh mesh = BaseMesh(client.read_scene(scene_name)).edited_as(edited);
  ASSERT_EQ(mesh.roots().size(), roots + 1);
  EXPECT_NEAR(mesh.roots().back().corners[0].y, 1.9, 1e-12);

  EXPECT_THAT(refusal(copied("lamp.2", "lamp.1", 0, 0, 0)), testing::HasSubstr("step.edits[1].copy.name"));
  EXPECT_THAT(refusal(copied("lamp.3", "lamp.9", 0, 0, 0)), testing::HasSubstr("step.edits[1].copy.of"));
  EXPECT_THAT(refusal(copied("lamp.3", "lamp.0", 1e12, 0, 0)), testing::HasSubstr("step.edits[0].object.move"));
  client.edit_solve(solve, undo());
  for (const LeafValue& leaf : end()) EXPECT_TRUE(leaf.patch.root_face() < roots || leaf.irradiance.max() == 0);
  EXPECT_THAT(refusal(moved("lamp.2", 0, 0, 0)), testing::HasSubstr("step.edits[0].object.name"));
  client.edit_solve(solve, copied("lamp.2", "lamp.1", -1, -1, 1));
  EXPECT_EQ(end().back().patch.root_face(), roots + 1) << "numbers of roots are not used again";
}

TEST_F(EditingTest, AWatchKnowsOfAddedObjectsBeforeTheirLeaves) {
  const auto stub = v1::SolveService::NewStub(server.channel());
  const std::size_t roots = BaseMesh(room()).roots().size();
  client.edit_solve(solve, copied("lamp.2", "lamp.0", 1, -1, 1));
  end();
  grpc::ClientContext context;
  v1::WatchSolveRequest request;
  request.set_name(solve);
  request.set_detail(v1::DETAIL_DISPLAY);
  const auto reader = stub->WatchSolve(&context, request);
  v1::WatchSolveResponse frame;
  ASSERT_TRUE(reader->Read(&frame));
  ASSERT_TRUE(frame.has_look()) << "the first frame";
  ASSERT_EQ(frame.look().objects_size(), 1);
  const v1::LookOfObject& copy = frame.look().objects(0);
  EXPECT_EQ(copy.number(), room().objects.size());
  EXPECT_EQ(copy.name(), "lamp.2");
  EXPECT_TRUE(copy.has_copy_of());
  EXPECT_EQ(copy.first_face(), room().faces.size());
  EXPECT_EQ(copy.face_count(), 1u);
  EXPECT_EQ(copy.motion(9), 1);
  EXPECT_EQ(frame.look().faces_size(), 0) << "it has the material of the other";
  EXPECT_GT(roots, 0u);
  context.TryCancel();
}

/// Returns a table with a lamp on it, as a scene of its own.
Scene table() {
  Scene scene;
  scene.materials = {test::grey(0, 0.4), test::grey(30'000, 0)};
  scene.materials[0].name = "wood", scene.materials[1].name = "glow";
  test::add_box(scene, {0, 0, 0}, {0.8, 0.7, 0.6}, false);
  test::add_polygon(scene, {{0.3, 0.9, 0.2}, {0.3, 0.9, 0.4}, {0.5, 0.9, 0.4}, {0.5, 0.9, 0.2}}, 1);
  return scene;
}

v1::EditStep added(const std::string& name, const std::string& scene) {
  v1::EditStep step = moved(name, 2.8, 0, 2);
  v1::ObjectCopy& copy = *step.add_edits()->mutable_copy();
  copy.set_name(name);
  copy.set_scene(scene);
  return step;
}

TEST_F(EditingTest, AnotherSceneIsAddedAsAnObjectAndKeptAsLongAsTheSolve) {
  const double before = mean(room(), end());
  const std::size_t roots = BaseMesh(room()).roots().size();
  const std::string other = client.create_scene(table(), "table").name();
  client.edit_solve(solve, added("table", other));
  const auto with = end();
  EXPECT_EQ(with.back().patch.root_face(), roots + 6);
  std::vector<LeafValue> of_room = with;
  std::erase_if(of_room, [&](const LeafValue& leaf) { return leaf.patch.root_face() >= roots; });
  EXPECT_GT(mean(room(), of_room), 1.02 * before) << "its lamp shines";
  const Scene edited = client.read_scene(solve);
  ASSERT_FALSE(find_fault(edited));
  EXPECT_EQ(edited.objects.back().from_scene, other);
  EXPECT_EQ(edited.materials.back().name, "glow of table");
  EXPECT_NEAR(edited.vertices.back().x, 2.8 + 0.5, 1e-12);
  EXPECT_EQ(client.read_scene(scene_name).faces.size(), room().faces.size()) << "the scene stays as it was submitted";

  v1::EditStep recoloured;
  recoloured.add_edits()->mutable_material()->set_name("wood of table");
  *recoloured.mutable_edits(0)->mutable_material()->mutable_reflectance() = encode(Rgb{0.8, 0, 0});
  client.edit_solve(solve, recoloured);
  end();

  EXPECT_THAT(refusal(added("other", "scenes/nobody")),
              testing::HasSubstr("step.edits[1].copy.scene: 'scenes/nobody' is no scene"));
  EXPECT_THAT(refusal(added("other", solve)), testing::HasSubstr("step.edits[1].copy.scene"));
  client.edit_solve(solve, undo());
  client.edit_solve(solve, undo());
  for (const LeafValue& leaf : end()) EXPECT_TRUE(leaf.patch.root_face() < roots || leaf.irradiance.max() == 0);
  try {
    client.delete_scene(other);
    FAIL() << "a redo needs it";
  } catch (const RpcError& error) {
    EXPECT_EQ(error.code, grpc::StatusCode::FAILED_PRECONDITION);
  }
  client.delete_solve(solve);
  client.delete_scene(other);
}

TEST_F(EditingTest, AWatchIsToldOfTheSceneThatWasAdded) {
  const auto stub = v1::SolveService::NewStub(server.channel());
  const std::string other = client.create_scene(table(), "table").name();
  client.edit_solve(solve, copied("lamp.2", "lamp.0", 1, -1, 1));
  client.edit_solve(solve, added("table", other));
  client.edit_solve(solve, added("second table", other));
  end();
  grpc::ClientContext context;
  v1::WatchSolveRequest request;
  request.set_name(solve);
  const auto reader = stub->WatchSolve(&context, request);
  v1::WatchSolveResponse frame;
  ASSERT_TRUE(reader->Read(&frame));
  ASSERT_EQ(frame.look().objects_size(), 3);
  EXPECT_TRUE(frame.look().objects(0).has_copy_of());
  const std::size_t faces = room().faces.size() + 1, materials = room().materials.size();
  for (int n = 1; n < 3; ++n) {
    const v1::LookOfObject& object = frame.look().objects(n);
    EXPECT_FALSE(object.has_copy_of());
    EXPECT_EQ(object.from_scene(), other);
    EXPECT_EQ(object.first_face(), faces + 7 * static_cast<std::size_t>(n - 1));
    EXPECT_EQ(object.face_count(), 7u);
    EXPECT_EQ(object.first_material(), materials + 2 * static_cast<std::size_t>(n - 1));
  }
  EXPECT_EQ(frame.look().materials_size(), 0);
  EXPECT_EQ(frame.look().faces_size(), 0);
  context.TryCancel();
}

TEST(EditedObjects, AnotherTenantsSceneIsNotFound) {
  SceneStore scenes;
  const std::string of_ann = scenes.add(table(), "", {"ann", ""})->facts.name;
  EXPECT_TRUE(scenes.use_if_there(of_ann, "ann"));
  EXPECT_FALSE(scenes.use_if_there(of_ann, "ben"));
}

}  // namespace
}  // namespace alvor
