// Edits of solves on a server that is killed and started again.

#include "tests/server/editing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <thread>

namespace alvor {
namespace {

using test::KeptEditsTest, test::coarse, test::mean, test::recolour, test::room;

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

/// Makes an edit until it is answered, on whatever server is there, always under one request id.
void insist(const std::function<std::string()>& address, v1::EditSolveRequest request) {
  for (grpc::Status status(grpc::UNKNOWN, ""); !status.ok();) {
    const auto stub = v1::SolveService::NewStub(grpc::CreateChannel(address(), grpc::InsecureChannelCredentials()));
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(5));
    v1::EditSolveResponse response;
    status = stub->EditSolve(&context, request, &response);
    ASSERT_TRUE(status.ok() || status.error_code() == grpc::UNAVAILABLE || status.error_code() == grpc::DEADLINE_EXCEEDED)
        << status.error_message();
  }
}

// The server is killed while a call is under way: whether that edit was kept is not known, so it is asked for again.
TEST_F(KeptEditsTest, AnEditThatIsAskedForAgainAfterAKillIsMadeOnce) {
  constexpr int count = 150;
  std::mutex lock;
  std::string address, solve;
  std::atomic<int> made = 0;
  std::thread editing;
  const auto begin = [&](Alvord& alvord) {
    const std::string listening = alvord.address();
    if (solve.empty()) {
      Client client(grpc::CreateChannel(listening, grpc::InsecureChannelCredentials()));
      v1::SolveSpec spec = coarse();
      spec.set_tolerance(0.03);
      solve = client.create_solve(client.create_scene(room(), "").name(), spec).name();
    }
    const std::lock_guard hold(lock);
    address = listening;
  };
  for (int kills = 0; made < count; ++kills) {
    Alvord alvord(arguments());
    begin(alvord);
    if (kills == 0)
      editing = std::thread([&] {
        for (int n = 1; n <= count; ++n) {
          v1::EditSolveRequest request;
          request.set_name(solve);
          *request.mutable_step() = recolour("m0", 0.005 * n, 0.1, 0.1);
          request.set_request_id("edit-" + std::to_string(n));
          insist(
              [&] {
                const std::lock_guard hold(lock);
                return address;
              },
              request);
          ++made;
        }
      });
    const int enough = std::min(count, made + 7 + 5 * kills);
    while (made < enough) std::this_thread::yield();
    alvord.kill();
  }
  editing.join();
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  const v1::Solve now = client.get_solve(solve);
  ASSERT_EQ(now.edits_size(), count);
  for (int n = 0; n < count; ++n) EXPECT_EQ(now.edits(n).edits(0).material().reflectance().r(), 0.005 * (n + 1)) << n;
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

TEST_F(KeptEditsTest, AddedScenesAreThereAfterARestartAndCannotBeDeleted) {
  std::string scene, solve;
  Scene other;
  other.materials = {test::grey(0, 0.4)};
  test::add_box(other, {2, 0.5, 2}, {2.5, 1, 2.5}, false);
  {
    Alvord alvord(arguments());
    Client client = client_of(alvord);
    solve = client.create_solve(client.create_scene(room(), "").name(), coarse()).name();
    scene = client.create_scene(other, "").name();
    v1::EditStep step;
    step.add_edits()->mutable_copy()->set_name("box");
    step.mutable_edits(0)->mutable_copy()->set_scene(scene);
    client.edit_solve(solve, step);
    alvord.kill();
  }
  Alvord alvord(arguments());
  Client client = client_of(alvord);
  Client::Watch watch;
  EXPECT_EQ(client.watch_solve(solve, watch, [](auto&) {}).last_step().edits(), 1u);
  const Scene edited = client.read_scene(solve);
  EXPECT_EQ(edited.objects.back().from_scene, scene);
  EXPECT_EQ(edited.faces.size(), room().faces.size() + other.faces.size());
  EXPECT_THROW(client.delete_scene(scene), RpcError);
}

}  // namespace
}  // namespace alvor
