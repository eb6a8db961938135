#include "client/rpc/client.h"
#include "google/rpc/error_details.pb.h"
#include "google/rpc/status.pb.h"
#include "proto/codec.h"
#include "tests/server/refusal.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/staged_solver.h"
#include "tests/server/test_server.h"

#include <gtest/gtest.h>

#include <thread>

namespace alvor {
namespace {

ServiceOptions staged(StagedSolver& stage) {
  ServiceOptions options;
  options.solves.solver = stage.solver();
  return options;
}

TEST(Api, SceneFarLargerThanAMessageComesBackAsItWas) {
  TestServer server;
  Client client(server.channel());
  const Scene scene = squares(60'000);  // 7 MB, while a message may have 4 MB
  const v1::Scene facts = client.create_scene(scene, "large");
  EXPECT_EQ(facts.face_count(), 60'000u);
  EXPECT_EQ(client.get_scene(facts.name()).display_name(), "large");
  const Scene back = client.read_scene(facts.name());
  EXPECT_EQ(back.vertices, scene.vertices);
  EXPECT_EQ(back.corners, scene.corners);
  EXPECT_EQ(back.faces.size(), scene.faces.size());
}

TEST(Api, BadScenesAreRefusedByPlaceAndNothingIsKept) {
  TestServer server;
  Client client(server.channel());
  for (const BadScene& bad : bad_scenes())
    EXPECT_EQ(error_of([&] { client.create_scene(bad.scene, ""); }).find("INVALID_ARGUMENT: " + bad.reason), 0u) << bad.reason;
  EXPECT_TRUE(client.list_scenes().empty());
}

TEST(Api, UploadBeyondTheLimitEndsEarly) {
  ServiceOptions options;
  options.upload.corners = 1000;
  TestServer server(options);
  Client client(server.channel());
  EXPECT_EQ(error_of([&] { client.create_scene(squares(30'000), ""); }),
            "RESOURCE_EXHAUSTED: scene: more than 1000 corners, the limit of this server");
}

/// Returns the messages that upload a scene in small chunks.
std::vector<v1::CreateSceneRequest> upload_of(const Scene& scene, const std::string& request_id) {
  std::vector<v1::CreateSceneRequest> messages(1);
  messages[0].mutable_scene()->set_display_name("room");
  messages[0].set_request_id(request_id);
  SceneSlicer slicer(scene, 400);
  for (v1::CreateSceneRequest message; slicer.next(*message.mutable_chunk());) messages.push_back(message);
  return messages;
}

TEST(Api, RefusalsTellProgramsTheFieldAndWhenToTryAgain) {
  TestServer server;
  Client client(server.channel());
  const auto stub = v1::SolveService::NewStub(server.channel());
  v1::CreateSolveRequest request;
  request.set_parent(client.create_scene(squares(1), "").name());
  request.mutable_solve()->mutable_spec()->set_tolerance(2);
  const auto refused = [&] {
    grpc::ClientContext context;
    v1::Solve solve;
    google::rpc::Status status;
    EXPECT_TRUE(status.ParseFromString(stub->CreateSolve(&context, request, &solve).error_details()));
    return status;
  };
  google::rpc::BadRequest bad;
  ASSERT_EQ(refused().details_size(), 1);
  ASSERT_TRUE(refused().details(0).UnpackTo(&bad));
  EXPECT_EQ(bad.field_violations(0).field(), "solve.spec.tolerance");
  EXPECT_EQ(bad.field_violations(0).description(), "2 is outside (0, 1]");
  server.stop_service();
  request.mutable_solve()->mutable_spec()->set_tolerance(0);
  google::rpc::RetryInfo retry;
  ASSERT_EQ(refused().details_size(), 1);
  ASSERT_TRUE(refused().details(0).UnpackTo(&retry));
  EXPECT_EQ(retry.retry_delay().seconds(), 1);
}

TEST(Api, UploadGoesOnWhereItBrokeOff) {
  TestServer server;
  const auto stub = v1::SceneService::NewStub(server.channel());
  const auto messages = upload_of(squares(20), "once");
  v1::Upload arrived;
  {
    grpc::ClientContext context;
    v1::Scene stored;
    const auto writer = stub->CreateScene(&context, &stored);
    for (int n = 0; n < 4; ++n) writer->Write(messages[static_cast<std::size_t>(n)]);
    context.TryCancel();
    EXPECT_FALSE(writer->Finish().ok());
  }
  v1::GetUploadRequest question;
  question.set_request_id("once");
  const auto ask = [&] {
    grpc::ClientContext context;
    return stub->GetUpload(&context, question, &arrived).ok();
  };
  while (!ask()) std::this_thread::yield();
  ASSERT_LE(arrived.chunk_count(), 3u);
  std::string name;
  for (const std::uint64_t sent : {arrived.chunk_count(), std::uint64_t{0}}) {  // resumes, then starts from the beginning
    grpc::ClientContext context;
    v1::Scene stored;
    const auto writer = stub->CreateScene(&context, &stored);
    auto first = messages[0];
    first.set_resume_after_chunks(sent);
    writer->Write(first);
    for (std::size_t n = 1 + sent; n < messages.size(); ++n) writer->Write(messages[n]);
    writer->WritesDone();
    const grpc::Status status = writer->Finish();
    ASSERT_TRUE(status.ok()) << status.error_message();
    EXPECT_EQ(stored.face_count(), 20u);
    if (name.empty()) name = stored.name();
    EXPECT_EQ(stored.name(), name);
  }
  EXPECT_FALSE(ask()) << "nothing waits any more";
}

TEST(Api, UploadFromWhichNothingComesIsEnded) {
  ServiceOptions options;
  options.upload.patience = std::chrono::milliseconds(1);
  TestServer server(options);
  const auto stub = v1::SceneService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::Scene stored;
  const auto writer = stub->CreateScene(&context, &stored);
  EXPECT_EQ(writer->Finish().error_code(), grpc::ABORTED);
}

TEST(Api, UploadThatIsBrokenOffLeavesNothing) {
  TestServer server;
  const auto stub = v1::SceneService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::Scene answer;
  const auto writer = stub->CreateScene(&context, &answer);
  v1::CreateSceneRequest message;
  message.mutable_scene();
  writer->Write(message);
  const Scene scene = squares(3);
  SceneSlicer(scene).next(*message.mutable_chunk());
  writer->Write(message);
  context.TryCancel();
  EXPECT_EQ(writer->Finish().error_code(), grpc::CANCELLED);
  EXPECT_TRUE(Client(server.channel()).list_scenes().empty());
}

TEST(Api, ErrorsNameTheResource) {
  TestServer server;
  Client client(server.channel());
  EXPECT_EQ(error_of([&] { client.get_scene("scenes/x"); }), "NOT_FOUND: scenes/x does not exist");
  EXPECT_EQ(error_of([&] { client.read_scene("scenes/x"); }), "NOT_FOUND: scenes/x does not exist");
  EXPECT_EQ(error_of([&] { client.create_solve("scenes/x", {}); }), "NOT_FOUND: scenes/x does not exist");
  EXPECT_EQ(error_of([&] { client.list_solves("scenes/x"); }), "NOT_FOUND: scenes/x does not exist");
  Client::Watch watch;
  EXPECT_EQ(error_of([&] { client.watch_solve("scenes/x/solves/y", watch, [](auto&) {}); }),
            "NOT_FOUND: scenes/x/solves/y does not exist");
  const std::string scene = client.create_scene(squares(1), "").name();
  v1::SolveSpec spec;
  spec.set_tolerance(2);
  EXPECT_EQ(error_of([&] { client.create_solve(scene, spec); }), "INVALID_ARGUMENT: solve.spec.tolerance: 2 is outside (0, 1]");
  v1::SolveSpec for_nobody;
  for_nobody.add_objects("nobody");
  EXPECT_EQ(error_of([&] { client.create_solve(scene, for_nobody); }),
            "INVALID_ARGUMENT: solve.spec.objects[0]: 'nobody' is no object of the scene");
}

TEST(Api, SceneLivesAsLongAsItsSolves) {
  StagedSolver stage;
  TestServer server(staged(stage));
  Client client(server.channel());
  const std::string scene = client.create_scene(squares(1), "").name();
  const std::string solve = client.create_solve(scene, {}).name();
  EXPECT_EQ(error_of([&] { client.delete_solve(solve); }), "FAILED_PRECONDITION: " + solve + " has not ended: cancel it first");
  EXPECT_EQ(error_of([&] { client.delete_scene(scene); }),
            "FAILED_PRECONDITION: " + scene + " has solves, or was added to one: delete these first");
  client.cancel_solve(solve);
  Client::Watch watch;
  EXPECT_EQ(client.watch_solve(solve, watch, [](auto&) {}).state(), v1::Solve::CANCELLED);
  client.delete_solve(solve);
  client.delete_scene(scene);
  EXPECT_TRUE(client.list_scenes().empty());
}

TEST(Api, ListsGoOverAllPages) {
  TestServer server;
  Client client(server.channel());
  for (int i = 0; i < 60; ++i) client.create_scene(squares(1), std::to_string(i));
  const auto all = client.list_scenes();
  ASSERT_EQ(all.size(), 60u);
  EXPECT_EQ(all.front().display_name(), "59");
  EXPECT_EQ(all.back().display_name(), "0");
}

TEST(Api, DarkSceneIsSolvedByTheRealSolver) {
  TestServer server;
  Client client(server.channel());
  Scene dark = squares(2);
  dark.materials[0].emission = {};
  v1::SolveSpec spec;
  spec.set_max_depth(0);
  Client::Watch watch;
  const auto started = client.create_solve(client.create_scene(dark, "").name(), spec);
  const auto solve = client.watch_solve(started.name(), watch, [](auto&) {});
  EXPECT_EQ(solve.state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(watch.mirror.leaf_count(), 2u);
}

TEST(Api, SolvesTellTheSpecThatIsCarriedOut) {
  StagedSolver stage;
  ServiceOptions options = staged(stage);
  options.solves.limits = {.leaves = 1000, .threads = 1};
  TestServer server(options);
  Client client(server.channel());
  v1::SolveSpec asked;
  asked.set_max_depth(3);
  const v1::Solve created = client.create_solve(client.create_scene(squares(1), "").name(), asked);
  const SolveOptions defaults;
  v1::SolveSpec effective = asked;
  effective.set_tolerance(defaults.tolerance);
  effective.set_max_elements(1000);
  effective.set_threads(1);
  effective.set_seed(defaults.seed);
  effective.set_form_factors(v1::FORM_FACTORS_NUSSELT);
  effective.set_priority(v1::PRIORITY_NORMAL);
  effective.set_area_share(1);
  for (const v1::Solve& told : {created, client.get_solve(created.name()), client.list_solves("scenes/-").at(0)}) {
    EXPECT_EQ(told.effective_spec().ShortDebugString(), effective.ShortDebugString());
    EXPECT_EQ(told.spec().ShortDebugString(), asked.ShortDebugString());
  }
}

TEST(Api, SolvesTellWhatTheirSceneNeeds) {
  TestServer server;
  Client client(server.channel());
  const Scene scene = squares(2);
  v1::SolveSpec spec;
  spec.set_max_depth(0);
  Client::Watch watch;
  const auto started = client.create_solve(client.create_scene(scene, "").name(), spec);
  client.watch_solve(started.name(), watch, [](auto&) {});
  const Plan plan(BaseMesh(scene), {.max_depth = 0});
  const auto told = decode(client.get_solve(started.name()).plan());
  EXPECT_TRUE(std::ranges::equal(told, plan.features()));
  EXPECT_FALSE(plan.needs(Feature::refinement));
}

}  // namespace
}  // namespace alvor
