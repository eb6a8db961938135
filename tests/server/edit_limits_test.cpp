// Edits that meet deletions, quotas and limits, and meshes as edits have made them.

#include "server/solves/solve_store.h"
#include "tests/server/editing.h"
#include "tests/server/refusal.h"
#include "tests/server/staged_solver.h"

#include <gtest/gtest.h>

#include <atomic>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace alvor {
namespace {

EditRequest request_to_dim(double dim, const std::string& author = "") {
  return {.step = {EditStep::Kind::edit, {LightEdit{.name = "bulb", .dim = dim}}}, .author = author};
}

/// A store whose solves end when the test says so.
class EditLimitsTest : public testing::Test {
 protected:
  std::shared_ptr<StoredSolve> create(SolveStore& solves, const SolveSpec& spec = {.max_elements = 600}) {
    return solves.create(scenes.use(scene), spec);
  }
  std::shared_ptr<StoredSolve> create_ended(SolveStore& solves) {
    const auto solve = create(solves);
    stage.finish();
    while (!solve->ended()) std::this_thread::yield();
    stage.begin_again();
    return solve;
  }
  SolveStore solves_with(const Quota& quota, int max_waiting = 8) {
    SolveStoreOptions options;
    options.quota = quota;
    options.max_running = 1;
    options.max_waiting = max_waiting;
    options.solver = stage.solver();
    return {options, scenes};
  }
  std::string refusal(SolveStore& solves, const std::string& solve) {
    return refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { solves.edit(solve, request_to_dim(0.5)); });
  }

  StagedSolver stage;
  SceneStore scenes;
  const std::string scene = scenes.add(test::room(), "")->facts.name;
};

TEST_F(EditLimitsTest, AnEditThatMakesASolveGoOnCountsAsOneThatIsStarted) {
  SolveStore solves = solves_with({.solves = 1, .leaves = 1000});
  const auto ended = create_ended(solves);
  const auto running = create(solves, {.max_elements = 500});
  EXPECT_EQ(refusal(solves, ended->name), "solves: 1 have not ended, as many as are allowed");
  EXPECT_TRUE(ended->describe().edits.empty()) << "nothing of it is kept";
  EXPECT_EQ(solves.edit(running->name, request_to_dim(0.5)), 1u) << "it runs already";
}

TEST_F(EditLimitsTest, TheLeavesOfASolveThatGoesOnCount) {
  SolveStore solves = solves_with({.solves = 5, .leaves = 1000});
  const auto ended = create_ended(solves);
  create(solves, {.max_elements = 500});
  EXPECT_EQ(refusal(solves, ended->name),
            "solve.spec.max_elements: with the other solves that have not ended 1100, 1000 are allowed");
}

TEST_F(EditLimitsTest, ASolveThatWaitsForItsTurnIsEdited) {
  SolveStore solves = solves_with({});
  create(solves);
  const auto waiting = create(solves);
  ASSERT_EQ(waiting->describe().status, SolveStatus::queued);
  EXPECT_EQ(solves.edit(waiting->name, request_to_dim(0.5)), 1u);
  EXPECT_EQ(waiting->content({}, std::nullopt)->scene.lights[0].intensity, 0.5 * test::room().lights[0].intensity);
}

TEST_F(EditLimitsTest, MoreThanAMebibyteOfStepsIsRefusedAndNothingIsLost) {
  SolveStore solves = solves_with({});
  const auto solve = create(solves);
  const std::string author(256, 'a');
  std::uint64_t revision = 0;
  std::string refusal;
  while (refusal.empty() && revision < 10'001)
    refusal = refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { revision = solves.edit(solve->name, request_to_dim(0.5, author)); });
  EXPECT_EQ(refusal, "the solve has " + std::to_string(revision) + " steps of edits, as many as are kept");
  EXPECT_GT(revision, 1000u);
  EXPECT_EQ(solve->describe().edits.size(), revision);
}

// A deletion waits for edits that began before it, and edits that come after it find nothing.
TEST_F(EditLimitsTest, EditsAndADeletionAtOnceAreEachMadeOrRefused) {
  SolveStore solves = solves_with({});
  for (int round = 0; round < 20; ++round) {
    const auto solve = create_ended(solves);
    std::atomic<int> made = 0;
    std::vector<std::thread> editors;
    for (int n = 0; n < 3; ++n)
      editors.emplace_back([&] {
        for (int k = 0; k < 5; ++k) {
          try {
            solves.edit(solve->name, request_to_dim(0.5));
            ++made;
          } catch (const StatusError& refusal) {
            EXPECT_EQ(refusal.code, grpc::NOT_FOUND) << refusal.what();
          }
        }
      });
    const std::string refusal = refusal_of(grpc::FAILED_PRECONDITION, [&] { solves.remove(solve->name); });
    for (std::thread& editor : editors) editor.join();
    if (refusal.empty()) {
      EXPECT_EQ(refusal_of(grpc::NOT_FOUND, [&] { solves.find(solve->name); }), solve->name + " does not exist");
    } else {  // an edit was first, and the solve goes on
      EXPECT_EQ(refusal, solve->name + " has not ended: cancel it first");
      EXPECT_GT(made, 0);
      EXPECT_EQ(solve->describe().edits.size(), static_cast<std::size_t>(made));
      stage.finish();
      while (!solve->ended()) std::this_thread::yield();
      stage.begin_again();
    }
  }
}

/// Returns the mesh that ReadMesh sends, as bytes.
std::string mesh_of(TestServer& server, const std::string& name, std::optional<std::uint64_t> edits = std::nullopt) {
  const auto stub = v1::SceneService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::ReadMeshRequest request;
  request.set_name(name);
  if (edits) request.set_edits(*edits);
  const auto reader = stub->ReadMesh(&context, request);
  std::string bytes;
  for (v1::ReadMeshResponse part; reader->Read(&part);) bytes += part.SerializeAsString();
  const grpc::Status status = reader->Finish();
  return status.ok() ? bytes : status.error_message();
}

using MeshOfEditsTest = test::EditingTest;

TEST_F(MeshOfEditsTest, IsReadAsAnyRevisionHasIt) {
  end();
  client.edit_solve(solve, test::moved("lamp.0", 1, 0, 0));
  const std::string once = mesh_of(server, solve);
  client.edit_solve(solve, test::moved("lamp.0", 1, 0, 1));
  client.edit_solve(solve, test::copied("lamp.2", "lamp.1", -1, 0, 1));
  EXPECT_EQ(mesh_of(server, solve, 0), mesh_of(server, scene_name));
  EXPECT_EQ(mesh_of(server, solve, 1), once);
  EXPECT_EQ(mesh_of(server, solve, 3), mesh_of(server, solve));
  EXPECT_NE(mesh_of(server, solve, 2), once);
  EXPECT_GT(mesh_of(server, solve, 3).size(), mesh_of(server, solve, 2).size()) << "a lamp more";
  EXPECT_EQ(mesh_of(server, solve, 4), "edits: there are none of revision 4 yet");
  EXPECT_NE(mesh_of(server, scene_name, 1).find("edits: "), std::string::npos) << "of a scene there are none";
}

}  // namespace
}  // namespace alvor
