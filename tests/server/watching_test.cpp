// Tests watchers of one solve over gRPC.

#include "client/rpc/client.h"
#include "tests/server/growing_leaves.h"
#include "tests/server/sample_scenes.h"
#include "tests/server/staged_solver.h"
#include "tests/server/test_server.h"

#include <gtest/gtest.h>

#include <future>

namespace alvor {
namespace {

class WatchingTest : public testing::Test {
 protected:
  static ServiceOptions options_for(StagedSolver& stage) {
    ServiceOptions options;
    options.solves.solver = stage.solver();
    return options;
  }
  void publish(int count) {
    for (int i = 0; i < count; ++i) stage.log().publish(leaves.next(), {});
  }
  /// Watches to the end on another thread.
  std::future<v1::Solve> follow(Client::Watch& watch) {
    return std::async(std::launch::async, [this, &watch] { return client.watch_solve(solve, watch, [](auto&) {}); });
  }
  /// Watches until `revision` is reached, then drops the connection.
  void watch_up_to(std::uint64_t revision, Client::Watch& watch) {
    std::stop_source stop;
    client.watch_solve(
        solve, watch,
        [&](const Client::Watch& at) {
          if (at.mirror.revision() >= revision) stop.request_stop();
        },
        stop.get_token());
    EXPECT_GE(watch.mirror.revision(), revision);
  }

  StagedSolver stage;
  TestServer server{options_for(stage)};
  Client client{server.channel()};
  std::string solve = client.create_solve(client.create_scene(squares(100), "").name(), {}).name();
  GrowingLeaves leaves{100, 7};
};

TEST_F(WatchingTest, EarlyLateAndReturningWatchersEndWithTheSameMirror) {
  Client::Watch early, returning, late;
  auto early_end = follow(early);
  publish(10);
  watch_up_to(10, returning);
  publish(10);
  watch_up_to(15, returning);
  auto returning_end = follow(returning);
  publish(10);
  auto late_end = follow(late);
  publish(5);
  const auto truth = stage.log().leaves();
  const auto steps = stage.log().steps().size();
  stage.finish();
  for (auto* end : {&early_end, &returning_end, &late_end}) EXPECT_EQ(end->get().state(), v1::Solve::SUCCEEDED);
  for (const auto* watch : {&early, &returning, &late}) {
    EXPECT_EQ(watch->mirror.leaves(), truth);
    EXPECT_EQ(watch->mirror.steps().size(), steps);
    EXPECT_TRUE(watch->mirror.whole());
  }
}

TEST_F(WatchingTest, SolutionOfManyFramesArrivesWhole) {
  std::vector<LeafValue> many;
  for (std::uint32_t root = 0; root < 120'000; ++root) many.push_back({PatchId::root(root), {float(root), 1, 2}});
  stage.log().publish(many, {});
  stage.finish();
  Client::Watch watch;
  int frames = 0;
  client.watch_solve(solve, watch, [&](auto&) { ++frames; });
  EXPECT_GE(frames, 3);
  EXPECT_EQ(watch.mirror.leaves(), many);
}

TEST_F(WatchingTest, ErrorsOfManyLeavesArriveAndOnlyWhereTheyAreWanted) {
  std::vector<LeafValue> many;
  std::vector<float> errors;
  for (std::uint32_t root = 0; root < 400'000; ++root) {
    many.push_back({PatchId::root(root), {1, 2, 3}});
    errors.push_back(static_cast<float>(1 + root % 100));
  }
  stage.log().publish(many, {}, errors);
  stage.finish();
  Client::Watch watch, other{.with_errors = false};
  client.watch_solve(solve, watch, [](auto&) {});
  client.watch_solve(solve, other, [](auto&) {});
  ASSERT_EQ(watch.mirror.errors().size(), many.size());
  for (std::size_t n = 0; n < many.size(); ++n) ASSERT_NEAR(watch.mirror.errors()[n], errors[n], 0.045 * errors[n]) << n;
  EXPECT_TRUE(other.mirror.errors().empty());
  EXPECT_EQ(other.mirror.leaves(), many);
}

TEST_F(WatchingTest, WatcherThatNeverAcknowledgesGetsTwoFramesAndHoldsNobodyUp) {
  const auto stub = v1::SolveService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::WatchSolveRequest request;
  request.set_name(solve);
  const auto reader = stub->WatchSolve(&context, request);
  v1::WatchSolveResponse frame;
  ASSERT_TRUE(reader->Read(&frame));
  publish(1);
  ASSERT_TRUE(reader->Read(&frame));
  publish(30);
  stage.finish();
  Client::Watch other;
  EXPECT_EQ(client.watch_solve(solve, other, [](auto&) {}).state(), v1::Solve::SUCCEEDED);
  EXPECT_EQ(other.mirror.revision(), 31u);
  context.TryCancel();
  EXPECT_FALSE(reader->Read(&frame));
}

TEST_F(WatchingTest, DisconnectedWatcherLeavesTheSolveRunning) {
  publish(3);
  Client::Watch watch;
  watch_up_to(3, watch);
  EXPECT_EQ(client.get_solve(solve).state(), v1::Solve::RUNNING);
}

TEST_F(WatchingTest, CancelledSolveIsStreamedToItsEnd) {
  publish(5);
  const auto truth = stage.log().leaves();
  client.cancel_solve(solve);
  Client::Watch watch;
  EXPECT_EQ(client.watch_solve(solve, watch, [](auto&) {}).state(), v1::Solve::CANCELLED);
  EXPECT_EQ(watch.mirror.leaves(), truth);
}

TEST_F(WatchingTest, MirrorOfAnotherEpochStartsAfresh) {
  publish(3);
  Client::Watch watch;
  watch_up_to(3, watch);
  watch.epoch = "of a server that has gone";
  stage.finish();
  client.watch_solve(solve, watch, [](auto&) {});
  EXPECT_EQ(watch.mirror.revision(), 3u);
  EXPECT_EQ(watch.mirror.steps().size(), 3u);
}

TEST_F(WatchingTest, MirrorAheadOfTheServerStartsAfresh) {
  publish(3);
  Client::Watch watch;
  watch_up_to(3, watch);
  Delta more;
  more.from_revision = 3;
  more.to_revision = more.head = 99;
  ASSERT_EQ(watch.mirror.apply(more), std::nullopt);
  stage.finish();
  client.watch_solve(solve, watch, [](auto&) {});
  EXPECT_EQ(watch.mirror.revision(), 3u);
  EXPECT_EQ(watch.mirror.steps().size(), 3u);
}

TEST_F(WatchingTest, AcknowledgingAWatchThatHasEndedIsNotFound) {
  const auto stub = v1::SolveService::NewStub(server.channel());
  grpc::ClientContext context;
  v1::AcknowledgeFrameRequest request;
  request.set_watch_id("w0");
  v1::AcknowledgeFrameResponse nothing;
  EXPECT_EQ(stub->AcknowledgeFrame(&context, request, &nothing).error_code(), grpc::NOT_FOUND);
}

TEST_F(WatchingTest, ServerThatStopsEndsItsWatches) {
  publish(1);
  Client::Watch watch;
  bool stopped = false;
  try {
    client.watch_solve(solve, watch, [&](auto&) {
      if (!stopped) server.stop_service();
      stopped = true;
    });
    FAIL() << "the watch went on to the end";
  } catch (const RpcError& error) {
    EXPECT_EQ(error.code, grpc::UNAVAILABLE);
  }
}

// Watchers join, leave and see publishing in as many interleavings as possible.
TEST_F(WatchingTest, ComingAndGoingWatchersDoNoHarm) {
  std::vector<std::future<void>> visitors;
  for (unsigned visitor = 0; visitor < 4; ++visitor)
    visitors.push_back(std::async(std::launch::async, [this] {
      Client::Watch watch;
      for (std::uint64_t revision = 1; revision <= 20; ++revision) watch_up_to(revision, watch);
    }));
  publish(30);
  for (auto& visitor : visitors) visitor.get();
  const auto truth = stage.log().leaves();
  stage.finish();
  Client::Watch last;
  client.watch_solve(solve, last, [](auto&) {});
  EXPECT_EQ(last.mirror.leaves(), truth);
}

}  // namespace
}  // namespace alvor
