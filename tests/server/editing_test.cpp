// EditSolve: what is asked and refused, who sees it, and that nothing of it is lost.

#include "tests/server/editing.h"
#include "radiosity/solve/solver.h"
#include "tests/server/refusal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <numbers>
#include <random>
#include <thread>

namespace alvor {
namespace {

using test::EditingTest, test::coarse, test::dim_light, test::live_options, test::mean, test::moved, test::recolour, test::redo,
    test::room, test::undo;

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

TEST_F(EditingTest, GlassIsMadeAndTold) {
  end();
  v1::EditStep step = recolour("m0", 0.2, 0.2, 0.2);
  *step.mutable_edits(0)->mutable_material()->mutable_regular_transmittance() = encode(Rgb{0.5, 0.6, 0.7});
  client.edit_solve(solve, step);
  end();
  EXPECT_EQ(last.state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(client.read_scene(solve).materials[0].regular_transmittance, (Rgb{0.5, 0.6, 0.7}));
  *step.mutable_edits(0)->mutable_material()->mutable_regular_transmittance() = encode(Rgb{0.9, 0.1, 0.1});
  EXPECT_NE(refusal(step).find("reflectance and transmittance are"), std::string::npos) << refusal(step);
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

TEST_F(EditingTest, TheSceneIsReadAsAnyRevisionOfItsEditsHasIt) {
  end();
  client.edit_solve(solve, recolour("m0", 0.1, 0.1, 0.1));
  client.edit_solve(solve, dim_light("bulb", 0));
  for (const double dim : {0.7, 0.5}) {  // a slide of two steps: revision 3 is no more
    v1::EditStep step = dim_light("sun", dim);
    step.set_continues(true);
    step.set_author("Ada");
    client.edit_solve(solve, step);
  }
  const auto emits = [&](std::optional<std::uint64_t> edits) { return client.read_scene(solve, edits).lights; };
  const auto grey = [&](std::uint64_t edits) { return client.read_scene(solve, edits).materials[0].reflectance; };
  EXPECT_EQ(grey(0), room().materials[0].reflectance);
  EXPECT_EQ(grey(1), (Rgb{0.1, 0.1, 0.1}));
  EXPECT_EQ(emits(1), room().lights);
  EXPECT_TRUE(emits(2)[0].intensity.is_zero());
  EXPECT_EQ(emits(2)[2].intensity, room().lights[2].intensity);
  EXPECT_EQ(emits(4), emits({}));
  const auto refusal_to_read = [&](const std::string& name, std::uint64_t edits) {
    return error_of([&] { client.read_scene(name, edits); });
  };
  EXPECT_EQ(refusal_to_read(solve, 3), "ABORTED: edits: revision 3 is no more, because a slide went on");
  EXPECT_EQ(refusal_to_read(solve, 5), "OUT_OF_RANGE: edits: there are none of revision 5 yet");
  EXPECT_EQ(refusal_to_read(scene_name, 0), "INVALID_ARGUMENT: edits: only solves have them");
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
  v1::EditStep nothing = dim_light("bulb", 0.5);
  nothing.add_edits();
  says(nothing, "step.edits[1]: has no part that this server knows");
  nothing.mutable_edits(1)->mutable_daylight()->set_sky(static_cast<v1::Daylight::Sky>(77));
  says(nothing, "step.edits[1].daylight.sky: 77 is none that this server knows");
  nothing.mutable_edits()->RemoveLast();
  nothing.set_kind(static_cast<v1::EditStep::Kind>(77));
  says(nothing, "step.kind: 77 is none that this server knows");
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

}  // namespace
}  // namespace alvor
