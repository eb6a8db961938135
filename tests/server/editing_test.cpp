// EditSolve: what is asked and refused, who sees it, and that nothing of it is lost.

#include "client/rpc/client.h"
#include "meshing/patch_place.h"
#include "proto/codec.h"
#include "radiosity/solve/solver.h"
#include "tests/radiosity/solve_scenes.h"
#include "tests/server/alvord_process.h"
#include "tests/server/refusal.h"
#include "tests/server/test_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <random>
#include <thread>

namespace alvor {
namespace {

namespace fs = std::filesystem;

v1::EditStep recolour(const std::string& material, double r, double g, double b) {
  v1::EditStep step;
  v1::MaterialEdit& edit = *step.add_edits()->mutable_material();
  edit.set_name(material);
  *edit.mutable_reflectance() = encode(Rgb{r, g, b});
  return step;
}

v1::EditStep dim_light(const std::string& light, double dim) {
  v1::EditStep step;
  step.add_edits()->mutable_light()->set_name(light);
  step.mutable_edits(0)->mutable_light()->set_dim(dim);
  return step;
}

v1::EditStep moved(const std::string& object, double x, double y, double z) {
  v1::EditStep step;
  step.add_edits()->mutable_object()->set_name(object);
  v1::Vector3& move = *step.mutable_edits(0)->mutable_object()->mutable_move();
  move.set_x(x), move.set_y(y), move.set_z(z);
  return step;
}

v1::EditStep undo() {
  v1::EditStep step;
  step.set_kind(v1::EditStep::UNDO);
  return step;
}
v1::EditStep redo() {
  v1::EditStep step;
  step.set_kind(v1::EditStep::REDO);
  return step;
}

/// Returns a room whose materials, lights and objects have names: the block on the floor, and two lamps of one material.
Scene room() {
  Scene scene = test::room_with_lamps_and_sun();
  for (std::size_t n = 0; n < scene.materials.size(); ++n) scene.materials[n].name = "m" + std::to_string(n);
  const auto first = static_cast<std::uint32_t>(scene.faces.size());
  test::add_polygon(scene, {{0.2, 2.9, 0.2}, {0.6, 2.9, 0.2}, {0.6, 2.9, 0.6}, {0.2, 2.9, 0.6}}, 1);
  test::add_polygon(scene, {{3.2, 2.9, 0.2}, {3.6, 2.9, 0.2}, {3.6, 2.9, 0.6}, {3.2, 2.9, 0.6}}, 1);
  for (std::uint32_t n = 0; n < 2; ++n) {
    SceneObject lamp;
    lamp.name = "lamp." + std::to_string(n);
    lamp.first_face = first + n;
    lamp.face_count = 1;
    scene.objects.push_back(lamp);
  }
  return scene;
}

v1::SolveSpec coarse() {
  v1::SolveSpec spec;
  spec.set_tolerance(0.1);
  spec.set_max_elements(3000);
  return spec;
}

ServiceOptions live_options() {
  ServiceOptions options;
  options.solves.keeping.keeps_live = true;
  return options;
}

double mean(const Scene& scene, const std::vector<LeafValue>& leaves) {
  const BaseMesh mesh(scene);
  double sum = 0, area = 0;
  for (const LeafValue& leaf : leaves) {
    const double own = area_of(mesh, shape_of(mesh, leaf.patch));
    sum += own * leaf.irradiance.mean();
    area += own;
  }
  return sum / area;
}

class EditingTest : public testing::Test {
 protected:
  EditingTest() {
    scene_name = client.create_scene(room(), "").name();
    solve = client.create_solve(scene_name, coarse()).name();
    end();
  }
  /// Waits for the end of the solve and returns its leaves.
  std::vector<LeafValue> end() {
    Client::Watch watch;
    last = client.watch_solve(solve, watch, [](auto&) {});
    return watch.mirror.leaves();
  }
  std::string refusal(const v1::EditStep& step, std::optional<std::uint64_t> base = std::nullopt) {
    try {
      client.edit_solve(solve, step, base);
    } catch (const RpcError& error) {
      return error.what();
    }
    return "";
  }

  TestServer server{live_options()};
  Client client{server.channel()};
  std::string scene_name, solve;
  v1::Solve last;
};

TEST_F(EditingTest, AFinishedSolveGoesOnAndItsSceneStays) {
  const auto before = end();
  const v1::EditSolveResponse edited = client.edit_solve(solve, recolour("m0", 0.1, 0.1, 0.1));
  EXPECT_EQ(edited.revision(), 1u);
  const auto after = end();
  EXPECT_EQ(last.state(), v1::Solve::SUCCEEDED);
  ASSERT_EQ(last.edits_size(), 1);
  EXPECT_EQ(last.edits(0).revision(), 1u);
  EXPECT_EQ(last.last_step().edits(), 1u);
  EXPECT_LT(mean(room(), after), 0.9 * mean(room(), before));
  EXPECT_EQ(client.read_scene(scene_name).materials[0].reflectance, room().materials[0].reflectance);
  EXPECT_EQ(client.read_scene(solve).materials[0].reflectance, (Rgb{0.1, 0.1, 0.1}));
}

TEST_F(EditingTest, UndoAndRedoAreEdits) {
  const auto before = end();
  client.edit_solve(solve, recolour("m0", 0.1, 0.1, 0.1));
  client.edit_solve(solve, dim_light("bulb", 0));
  EXPECT_EQ(client.edit_solve(solve, undo()).revision(), 3u);
  EXPECT_EQ(client.read_scene(solve).lights[0].intensity, room().lights[0].intensity);
  EXPECT_EQ(client.read_scene(solve).materials[0].reflectance, (Rgb{0.1, 0.1, 0.1}));
  client.edit_solve(solve, undo());
  EXPECT_EQ(client.read_scene(solve).materials[0].reflectance, room().materials[0].reflectance);
  EXPECT_NE(refusal(undo()).find("FAILED_PRECONDITION: step.kind: there is nothing to undo"), std::string::npos);
  EXPECT_NEAR(mean(room(), end()), mean(room(), before), 0.02 * mean(room(), before));
  client.edit_solve(solve, redo());
  EXPECT_EQ(client.read_scene(solve).materials[0].reflectance, (Rgb{0.1, 0.1, 0.1}));
  client.edit_solve(solve, dim_light("sun", 0.5));
  EXPECT_NE(refusal(redo()).find("FAILED_PRECONDITION"), std::string::npos);
}

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

v1::EditStep copied(const std::string& name, const std::string& of, double x, double y, double z) {
  v1::EditStep step = moved(name, x, y, z);
  v1::ObjectCopy& copy = *step.add_edits()->mutable_copy();
  copy.set_name(name);
  copy.set_of(of);
  return step;
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

TEST_F(EditingTest, ADayPassesAndIsOneStep) {
  const std::vector<LeafValue> before = end();
  v1::EditStep step;
  step.set_author("Ada");
  step.set_continues(true);
  v1::Daylight& daylight = *step.add_edits()->mutable_daylight();
  daylight.set_sky(v1::Daylight::CIE);
  daylight.set_cie_number(12);
  v1::SunTime& time = *daylight.mutable_sun_time();
  time.set_latitude_degrees(48.1);
  time.set_longitude_degrees(11.6);
  for (const int hour : {6, 9, 12}) {
    time.mutable_time()->set_seconds(1'782'000'000 + 3600 * hour);  // 2026-06-21
    client.edit_solve(solve, step);
  }
  const std::vector<LeafValue> at_noon = end();
  const v1::Solve noted = client.get_solve(solve);
  ASSERT_EQ(noted.edits_size(), 1);
  EXPECT_EQ(noted.edits(0).edits(0).daylight().sun_time().time().seconds(), 1'782'043'200);
  const Scene edited = client.read_scene(solve);
  ASSERT_EQ(edited.lights.size(), 4u);
  EXPECT_EQ(edited.lights[2].name, "sun");
  EXPECT_NEAR(std::asin(-edited.lights[2].direction.y) * 180 / std::numbers::pi, 63.8, 0.5)
      << "Munich, 50 minutes after the sun was highest, at 65.3 degrees";
  EXPECT_GT(mean(edited, at_noon), 1.5 * mean(edited, before));
  step.set_continues(false);
  time.mutable_time()->set_seconds(1'782'000'000 - 3600);
  for (const char* lamp : {"bulb", "spot"}) *step.add_edits() = dim_light(lamp, 0).edits(0);
  step.add_edits()->mutable_material()->set_name("m1");
  *step.mutable_edits(step.edits_size() - 1)->mutable_material()->mutable_emission() = encode(Rgb{});
  client.edit_solve(solve, step);
  EXPECT_EQ(mean(edited, end()), 0) << "a night without lamps";
  for (int n = 0; n < 2; ++n) client.edit_solve(solve, undo());
  end();
  EXPECT_EQ(client.read_scene(solve).lights, room().lights);
}

TEST_F(EditingTest, RefusesWhatCannotBeAndNamesTheEditAndItsField) {
  const auto says = [&](const v1::EditStep& step, const std::string& text) {
    EXPECT_NE(refusal(step).find("INVALID_ARGUMENT: " + text), std::string::npos) << refusal(step);
  };
  says(v1::EditStep(), "step.edits: there are none");
  says(recolour("wall", 0, 0, 0), "step.edits[0].material.name: 'wall' is no material of the scene");
  v1::EditStep second = recolour("m0", 0.5, 0.5, 0.5);
  *second.add_edits() = recolour("m0", 0.5, 1, 0.5).edits(0);
  says(second, "step.edits[1].material.reflectance: must be in [0, 1)");
  says(recolour("m0", NAN, 0, 0), "step.edits[0].material.reflectance");
  says(dim_light("bulb", -1), "step.edits[0].light.dim: must be in [0, 1e6]");
  says(dim_light("moon", 1), "step.edits[0].light.name: 'moon' is no light of the scene");
  v1::EditStep far;
  far.add_edits()->mutable_light()->set_name("bulb");
  far.mutable_edits(0)->mutable_light()->mutable_position()->set_x(1e12);
  says(far, "step.edits[0].light.position: must lie within 1e9 m");
  far.mutable_edits(0)->mutable_light()->set_name("sun");
  says(far, "step.edits[0].light.position: 'sun' shines from infinitely far away");
  says(moved("lamp.0", 1e12, 0, 0),
       "step.edits[0].object.move: 'lamp.0' would lie farther from the scene than the scene is long");
  says(moved("lamp.0", NAN, 0, 0), "step.edits[0].object.move");
  says(moved("chair", 1, 0, 0), "step.edits[0].object.name: 'chair' is no object of the scene");
  v1::EditStep many;
  for (int n = 0; n < 10'000; ++n) *many.add_edits() = dim_light("bulb", 0.5).edits(0);
  says(many, "step.edits: 10000, at most 1000 are allowed");
  v1::EditStep nothing;
  nothing.add_edits();
  says(nothing, "step: an edit has no part");
  v1::EditStep high;
  high.add_edits()->mutable_daylight()->set_sun_azimuth_degrees(10);
  high.mutable_edits(0)->mutable_daylight()->set_sun_elevation_degrees(100);
  says(high, "step.edits[0].daylight: its elevation of the sun is out of range");
  v1::EditStep dark;
  for (const char* light : {"bulb", "spot", "sun"}) *dark.add_edits() = dim_light(light, 0).edits(0);
  v1::MaterialEdit& lamp = *dark.add_edits()->mutable_material();
  lamp.set_name("m1");
  *lamp.mutable_emission() = encode(Rgb{});
  says(dark, "step.edits: then nothing in the scene would shine");
  v1::EditStep nameless = recolour("m0", 0, 0, 0);
  nameless.set_author(std::string(300, 'a'));
  says(nameless, "step.author");
  EXPECT_EQ(client.get_solve(solve).edits_size(), 0);
  EXPECT_EQ(client.get_solve(solve).state(), v1::Solve::SUCCEEDED);
}

TEST_F(EditingTest, OfTwoWhoEditAtOnceOneIsTold) {
  client.edit_solve(solve, recolour("m0", 0.2, 0.2, 0.2), 0);
  EXPECT_NE(refusal(recolour("m0", 0.3, 0.3, 0.3), 0).find("ABORTED: base_revision: 0, but the newest edits are of revision 1"),
            std::string::npos);
  EXPECT_EQ(refusal(recolour("m0", 0.3, 0.3, 0.3), 1), "");
}

TEST_F(EditingTest, ARepeatedRequestMakesNoFurtherStep) {
  const auto stub = v1::SolveService::NewStub(server.channel());
  v1::EditSolveRequest request;
  request.set_name(solve);
  request.set_request_id("once");
  *request.mutable_step() = recolour("m0", 0.2, 0.2, 0.2);
  for (int n = 0; n < 2; ++n) {
    grpc::ClientContext context;
    v1::EditSolveResponse response;
    ASSERT_TRUE(stub->EditSolve(&context, request, &response).ok());
    EXPECT_EQ(response.revision(), 1u);
  }
  *request.mutable_step() = undo();
  grpc::ClientContext context;
  v1::EditSolveResponse response;
  EXPECT_EQ(stub->EditSolve(&context, request, &response).error_code(), grpc::INVALID_ARGUMENT);
}

TEST_F(EditingTest, ASlideIsOneStep) {
  for (int n = 1; n <= 20; ++n) {
    v1::EditStep step = dim_light("bulb", 0.05 * n);
    step.set_continues(true);
    EXPECT_EQ(client.edit_solve(solve, step).revision(), static_cast<std::uint64_t>(n));
  }
  v1::EditStep other = dim_light("spot", 0.5);
  other.set_continues(true);
  client.edit_solve(solve, other);
  EXPECT_EQ(client.get_solve(solve).edits_size(), 2);
  client.edit_solve(solve, undo());
  client.edit_solve(solve, undo());
  EXPECT_EQ(client.read_scene(solve).lights[0].intensity, room().lights[0].intensity);
  end();
  EXPECT_EQ(last.last_step().edits(), 23u);
}

TEST_F(EditingTest, ACancelOfAnEndedSolveDoesNotReachAnEditedOne) {
  client.cancel_solve(solve);  // has no effect: it has ended
  client.edit_solve(solve, recolour("m0", 0.1, 0.1, 0.1));
  client.pause_solve(solve);
  v1::Solve::State state;
  do state = client.get_solve(solve).state();
  while (state == v1::Solve::QUEUED || state == v1::Solve::RUNNING);
  EXPECT_TRUE(state == v1::Solve::PAUSED || state == v1::Solve::SUCCEEDED) << state;
}

TEST_F(EditingTest, ADarkSceneIsSolvedOnceForEachEdit) {
  Scene dark = test::black(test::coloured_room());
  for (std::size_t n = 0; n < dark.materials.size(); ++n) {
    dark.materials[n].name = "m" + std::to_string(n);
    dark.materials[n].emission = {};
  }
  solve = client.create_solve(client.create_scene(dark, "").name(), coarse()).name();
  end();
  client.edit_solve(solve, recolour("m0", 0.5, 0.5, 0.5));
  end();
  EXPECT_EQ(last.last_step().edits(), 1u);
  EXPECT_EQ(last.last_step().step(), 1u);
  v1::EditStep shine;
  shine.add_edits()->mutable_material()->set_name("m0");
  *shine.mutable_edits(0)->mutable_material()->mutable_emission() = encode(Rgb{1, 1, 1});
  client.edit_solve(solve, shine);
  EXPECT_GT(mean(dark, end()), 0);
  client.edit_solve(solve, undo());
  EXPECT_EQ(mean(dark, end()), 0);
  EXPECT_EQ(last.last_step().edits(), 3u);
}

TEST_F(EditingTest, EditsInTheMomentOfTheEndAreHeeded) {
  for (int n = 1; n <= 60; ++n) {
    client.edit_solve(solve, dim_light("bulb", 0.01 * n));
    if (n % 3 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(n));  // some come while it ends
  }
  end();
  EXPECT_EQ(last.state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(last.last_step().edits(), 60u);
}

TEST_F(EditingTest, CancelledSolvesAreNotEdited) {
  v1::SolveSpec long_one = coarse();
  *long_one.mutable_step_pause() = encode_seconds(60);
  solve = client.create_solve(scene_name, long_one).name();
  client.cancel_solve(solve);
  end();
  EXPECT_NE(refusal(recolour("m0", 0, 0, 0)).find("FAILED_PRECONDITION"), std::string::npos);
  client.delete_solve(solve);
  EXPECT_NE(refusal(recolour("m0", 0, 0, 0)).find("NOT_FOUND"), std::string::npos);
}

TEST_F(EditingTest, APausedSolveHeedsEditsWhenItGoesOn) {
  v1::SolveSpec slow = coarse();
  slow.set_tolerance(0.03);
  *slow.mutable_step_pause() = encode_seconds(0.02);
  solve = client.create_solve(scene_name, slow).name();
  client.pause_solve(solve);
  while (client.get_solve(solve).state() != v1::Solve::PAUSED) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  EXPECT_EQ(client.edit_solve(solve, recolour("m0", 0.1, 0.1, 0.1)).state(), v1::Solve::PAUSED);
  client.resume_solve(solve);
  end();
  EXPECT_EQ(last.state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(last.last_step().edits(), 1u);
}

TEST_F(EditingTest, AWatchThatFollowsEditsSeesThemAndHowSurfacesLook) {
  const auto stub = v1::SolveService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::WatchSolveRequest request;
  request.set_name(solve);
  request.set_follow_edits(true);
  const auto reader = stub->WatchSolve(&context, request);
  std::uint64_t frames = 0;
  SolutionMirror mirror;
  v1::Look look;
  bool is_edited = false;
  for (v1::WatchSolveResponse frame; reader->Read(&frame);) {
    Delta delta;
    ASSERT_FALSE(decode(frame, delta));
    ASSERT_EQ(mirror.apply(delta), std::nullopt);
    if (frame.has_look()) look = frame.look();
    v1::AcknowledgeFrameRequest acknowledgement;
    acknowledgement.set_watch_id(frame.watch_id());
    acknowledgement.set_revision(frame.to_revision());
    acknowledgement.set_frame_count(++frames);
    grpc::ClientContext own;
    v1::AcknowledgeFrameResponse nothing;
    EXPECT_TRUE(stub->AcknowledgeFrame(&own, acknowledgement, &nothing).ok());
    if (!frame.ended()) continue;
    EXPECT_EQ(mirror.leaves(), end());
    if (is_edited) break;
    EXPECT_FALSE(frame.has_look());
    v1::EditStep step = recolour("m0", 0.1, 0.2, 0.3);
    step.add_edits()->mutable_object()->set_name("lamp.1");
    step.mutable_edits(1)->mutable_object()->set_dim(0.5);
    *step.add_edits() = moved("lamp.0", 1, 0, 2).edits(0);
    client.edit_solve(solve, step);
    is_edited = true;
  }
  context.TryCancel();
  ASSERT_EQ(look.edits(), 1u);
  ASSERT_EQ(look.materials_size(), 2);
  EXPECT_EQ(decode(look.materials(0).material().reflectance()), (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(look.materials(1).number(), room().materials.size());
  ASSERT_EQ(look.faces_size(), 1);
  EXPECT_EQ(look.faces(0).first_face(), room().faces.size() - 1);
  EXPECT_EQ(look.faces(0).face_count(), 1u);
  EXPECT_EQ(look.faces(0).material(), room().materials.size());
  ASSERT_EQ(look.objects_size(), 1);
  EXPECT_EQ(look.objects(0).number(), 0u);
  EXPECT_THAT(look.objects(0).motion(), testing::ElementsAre(1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 2));
}

TEST_F(EditingTest, WhileItRunsEveryEditIsHeeded) {
  v1::SolveSpec slow = coarse();
  slow.set_tolerance(0.04);
  solve = client.create_solve(scene_name, slow).name();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.05, 0.8);
  for (int n = 0; n < 100; ++n)
    client.edit_solve(
        solve, n % 3 == 0 ? dim_light("bulb", share(random)) : recolour("m0", share(random), share(random), share(random)));
  const auto leaves = end();
  EXPECT_EQ(last.last_step().edits(), 100u);
  EXPECT_EQ(last.state(), v1::Solve::SUCCEEDED);
  SolutionLog anew;
  const Scene edited = client.read_scene(solve);
  alvor::solve(BaseMesh(edited), {.tolerance = 0.04, .max_leaves = 3000}, anew, {});
  const double truth = mean(room(), anew.leaves());
  EXPECT_NEAR(mean(room(), leaves), truth, (last.last_step().estimated_error() + anew.last_step().estimated_error) * truth);
}

TEST(Editing, OfAnotherTenantIsNotFound) {
  SceneStore scenes;
  const auto scene = scenes.add(room(), "", {"ann", ""});
  SolveStore solves({}, scenes);
  const auto solve = solves.create(scenes.use(scene->facts.name, "ann"), {.tolerance = 0.1}, {"ann", ""});
  const EditRequest request{.step = {EditStep::Kind::edit, {LightEdit{.name = "bulb", .dim = 0.5}}}};
  EXPECT_EQ(refusal_of(grpc::NOT_FOUND, [&] { solves.edit(solve->name, request, "ben"); }), solve->name + " does not exist");
  EXPECT_EQ(solves.edit(solve->name, request, "ann"), 1u);
}

class KeptEditsTest : public testing::Test {
 protected:
  KeptEditsTest() { fs::remove_all(directory); }
  ~KeptEditsTest() override { fs::remove_all(directory); }
  std::vector<std::string> arguments() const {
    return {"--listen", "127.0.0.1:0", "--data", directory.string(), "--checkpoint-interval", "0.05"};
  }
  static Client client_of(Alvord& alvord) {
    return Client(grpc::CreateChannel(alvord.address(), grpc::InsecureChannelCredentials()));
  }
  const fs::path directory = fs::temp_directory_path() / ("alvor_edits_" + std::to_string(getpid()) + "_" +
                                                          testing::UnitTest::GetInstance()->current_test_info()->name());
};

TEST_F(KeptEditsTest, KilledInTheMiddleOfEditsEveryAcknowledgedOneIsThereAndNoneTwice) {
  std::string scene, solve;
  std::vector<double> acknowledged;
  for (int round = 0; round < 4; ++round) {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    if (round == 0) {
      v1::SolveSpec spec = coarse();
      spec.set_tolerance(0.05);
      *spec.mutable_step_pause() = encode_seconds(0.01);
      scene = client.create_scene(room(), "").name();
      solve = client.create_solve(scene, spec).name();
    }
    const v1::Solve now = client.get_solve(solve);
    ASSERT_EQ(now.edits_size(), static_cast<int>(acknowledged.size())) << round;
    for (int n = 0; n < now.edits_size(); ++n) {
      EXPECT_EQ(now.edits(n).edits(0).material().reflectance().r(), acknowledged[static_cast<std::size_t>(n)]);
      EXPECT_EQ(now.edits(n).revision(), static_cast<std::uint64_t>(n + 1));
    }
    for (int n = 0; n < 5 + round; ++n) {
      const double value = 0.01 * static_cast<double>(acknowledged.size() + 1);
      client.edit_solve(solve, recolour("m0", value, value, value));
      acknowledged.push_back(value);
      std::this_thread::sleep_for(std::chrono::milliseconds(17 * round));
    }
    alvord.kill();
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  Client::Watch watch;
  const v1::Solve ended = client.watch_solve(solve, watch, [](auto&) {});
  EXPECT_EQ(ended.state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(ended.last_step().edits(), acknowledged.size());
  EXPECT_EQ(client.read_scene(solve).materials[0].reflectance.r, acknowledged.back());
}

TEST_F(KeptEditsTest, AFinishedSolveIsEditedAfterARestart) {
  std::string solve;
  {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    solve = client.create_solve(client.create_scene(room(), "").name(), coarse()).name();
    Client::Watch watch;
    client.watch_solve(solve, watch, [](auto&) {});
    alvord.kill();
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  Client::Watch watch;
  client.watch_solve(solve, watch, [](auto&) {});
  const double before = mean(room(), watch.mirror.leaves());
  client.edit_solve(solve, recolour("m0", 0.1, 0.1, 0.1));
  // The watch goes on from what it has, without a reset.
  const std::uint64_t revision = watch.mirror.revision();
  const v1::Solve ended = client.watch_solve(solve, watch, [](auto&) {});
  EXPECT_GT(watch.mirror.revision(), revision);
  EXPECT_EQ(ended.last_step().edits(), 1u);
  EXPECT_LT(mean(room(), watch.mirror.leaves()), 0.9 * before);
}

}  // namespace
}  // namespace alvor
