#include "server/watch/watch.h"

#include "proto/codec.h"
#include "solution/solution_mirror.h"
#include "tests/server/growing_leaves.h"
#include "tests/server/refusal.h"
#include "tests/server/sample_scenes.h"

#include <gtest/gtest.h>

namespace alvor {
namespace {

using namespace std::chrono_literals;

v1::WatchSolveResponse parse(const Frame& frame) {
  v1::WatchSolveResponse message;
  EXPECT_TRUE(message.ParseFromArray(frame.bytes.begin(), static_cast<int>(frame.bytes.size())));
  return message;
}

struct Recorder final : FrameSink {
  void write(const Frame& frame) override {
    EXPECT_FALSE(status) << "written to after it was finished";
    frames.push_back(parse(frame));
    starts.push_back(frame.bytes.begin());
  }
  void give_up() override { given_up = true; }
  void finish(const grpc::Status& reason) override {
    EXPECT_FALSE(status) << "finished twice";
    status = reason;
  }
  std::vector<v1::WatchSolveResponse> frames;
  std::vector<const std::uint8_t*> starts;
  std::optional<grpc::Status> status;
  bool given_up = false;
};

class WatchTest : public testing::Test {
 protected:
  static constexpr std::size_t page = 10;
  void publish() { solve->log()->publish(leaves.next(), {}); }
  void end() {
    solve->run([](auto&, auto&, auto&, SolutionLog&, const SolveControl&) { return SolveOutcome{}; }, {}, {}, {});
  }
  std::shared_ptr<StoredSolve> make_solve() {
    return std::make_shared<StoredSolve>(1, scenes.add(squares(4), ""), Caller{}, SolveSpec{}, SolveOptions{}, Keeping{});
  }
  /// Completes a frame on the watcher's side: it was written, applied and acknowledged.
  void deliver(SolutionMirror* mirror = nullptr) {
    watch.written(true);
    if (mirror) {
      Delta delta;
      EXPECT_FALSE(decode(sink.frames.back(), delta));
      EXPECT_EQ(mirror->apply(delta), std::nullopt);
    }
    watch.acknowledge(sink.frames.size(), sink.frames.back().to_revision());
  }

  SceneStore scenes;
  std::shared_ptr<StoredSolve> solve = make_solve();
  std::shared_ptr<FrameSource> frames = std::make_shared<FrameSource>(solve, "e1", page);
  GrowingLeaves leaves{4, 1};
  Watch::Clock::time_point now{1h};
  Recorder sink;
  Watch watch{frames, {.min_interval = 100ms}, sink};
};

TEST_F(WatchTest, FirstFrameGoesOutAtOnceEvenIfEmpty) {
  watch.take_turn(now);
  ASSERT_EQ(sink.frames.size(), 1u);
  EXPECT_EQ(sink.frames[0].head_revision(), 0u);
  EXPECT_EQ(sink.frames[0].epoch(), "e1");
}

TEST_F(WatchTest, NoMoreThanTwoFramesGoUnacknowledged) {
  for (int i = 0; i < 10; ++i, now += 1s) {
    publish();
    watch.take_turn(now);
    watch.written(true);
  }
  EXPECT_EQ(sink.frames.size(), 2u);
  watch.acknowledge(1, sink.frames[0].to_revision());
  watch.take_turn(now);
  EXPECT_EQ(sink.frames.size(), 3u);
}

TEST_F(WatchTest, OnlyOneFrameIsWrittenAtATime) {
  publish();
  watch.take_turn(now);
  publish();
  watch.take_turn(now + 1s);
  EXPECT_EQ(sink.frames.size(), 1u);
  watch.written(true);
  watch.take_turn(now + 1s);
  EXPECT_EQ(sink.frames.size(), 2u);
}

TEST_F(WatchTest, KeepsItsPaceWithOneTimer) {
  publish();
  watch.take_turn(now);
  deliver();
  publish();
  EXPECT_EQ(watch.take_turn(now + 30ms), now + 100ms);
  EXPECT_EQ(watch.take_turn(now + 60ms), std::nullopt) << "the turn asked for before will do";
  EXPECT_EQ(sink.frames.size(), 1u);
  watch.take_turn(now + 100ms);
  EXPECT_EQ(sink.frames.size(), 2u);
}

TEST_F(WatchTest, KeepsToItsBytesPerSecond) {
  Recorder slow_sink;
  Watch slow(frames, {.max_bytes_per_s = 10}, slow_sink);
  publish();
  slow.take_turn(now);
  slow.written(true);
  publish();
  const auto due = slow.take_turn(now);
  ASSERT_TRUE(due);
  EXPECT_GT(*due, now + 5s);
  EXPECT_EQ(slow_sink.frames.size(), 1u);
  slow.take_turn(*due);
  EXPECT_EQ(slow_sink.frames.size(), 2u);
}

TEST_F(WatchTest, SilenceIsBrokenByBookmarks) {
  publish();
  watch.take_turn(now);
  deliver();
  EXPECT_EQ(watch.take_turn(now + 1s), now + Watch::bookmark_interval);
  watch.take_turn(now + Watch::bookmark_interval);
  ASSERT_EQ(sink.frames.size(), 2u);
  EXPECT_EQ(sink.frames[1].leaves().count(), 0u);
  EXPECT_EQ(sink.frames[1].to_revision(), 1u);
  EXPECT_TRUE(sink.frames[1].has_state_hash());
}

TEST_F(WatchTest, WriteThatDoesNotEndIsGivenUp) {
  publish();
  EXPECT_EQ(watch.take_turn(now), now + Watch::patience);
  watch.take_turn(now + Watch::patience - 1s);
  EXPECT_FALSE(sink.given_up);
  watch.take_turn(now + Watch::patience);
  EXPECT_TRUE(sink.given_up);
  watch.written(false);
  watch.take_turn(now + Watch::patience);
  EXPECT_EQ(sink.status->error_code(), grpc::CANCELLED);
}

TEST_F(WatchTest, ClosingIsSaidBeforeTheEnd) {
  publish();
  watch.take_turn(now);
  v1::Closing closing;
  closing.set_reason("tea");
  watch.close(closing);
  watch.take_turn(now);
  EXPECT_EQ(sink.frames.size(), 1u) << "a write is under way";
  watch.written(true);
  watch.take_turn(now);
  ASSERT_EQ(sink.frames.size(), 2u);
  EXPECT_EQ(sink.frames[1].closing().reason(), "tea");
  EXPECT_FALSE(sink.status);
  watch.written(true);
  watch.take_turn(now);
  EXPECT_EQ(sink.status->error_code(), grpc::UNAVAILABLE);
}

TEST_F(WatchTest, DetailsAreFramesOfTheirOwn) {
  Recorder other_sink;
  Watch other(frames, {.detail = Detail::display}, other_sink);
  publish();
  watch.take_turn(now);
  other.take_turn(now);
  EXPECT_EQ(sink.frames[0].leaves().detail(), v1::DETAIL_EXACT);
  EXPECT_EQ(other_sink.frames[0].leaves().detail(), v1::DETAIL_DISPLAY);
}

TEST_F(WatchTest, SlowWatcherGetsNewestValuesOnly) {
  publish();
  watch.take_turn(now);
  deliver();
  for (int i = 0; i < 100; ++i) solve->log()->publish(std::vector<LeafValue>{{PatchId::root(0), {float(i), 0, 0}}}, {});
  watch.take_turn(now + 1s);
  Delta delta;
  ASSERT_FALSE(decode(sink.frames[1], delta));
  EXPECT_EQ(delta.values, (std::vector<LeafValue>{{PatchId::root(0), {99, 0, 0}}}));
  EXPECT_EQ(sink.frames[1].steps_size(), 100);
}

TEST_F(WatchTest, PagesOfAGrowingSolutionMakeTheMirrorEqual) {
  SolutionMirror mirror;
  for (int i = 0; i < 60; ++i, now += 1s) {
    if (i < 40) publish();
    const std::size_t before = sink.frames.size();
    watch.take_turn(now);
    if (sink.frames.size() == before) continue;
    EXPECT_LE(sink.frames.back().leaves().count(), page);
    deliver(&mirror);
  }
  end();
  for (; !sink.status; now += 1s) {
    watch.take_turn(now);
    if (!sink.status) deliver(&mirror);
  }
  EXPECT_TRUE(sink.status->ok());
  EXPECT_TRUE(sink.frames.back().ended());
  EXPECT_TRUE(mirror.whole());
  EXPECT_EQ(mirror.leaves(), solve->log()->leaves());
}

TEST_F(WatchTest, LastFrameWaitsForTheFinalState) {
  publish();
  solve->log()->close();  // as the solver does before it returns
  watch.take_turn(now);
  EXPECT_FALSE(sink.frames[0].ended());
  deliver();
  watch.take_turn(now += 1s);
  EXPECT_EQ(sink.frames.size(), 1u);
  bool woken = false;
  solve->log()->listen([&] { woken = solve->ended(); });
  end();
  EXPECT_TRUE(woken);
  watch.take_turn(now += 1s);
  ASSERT_EQ(sink.frames.size(), 2u);
  EXPECT_TRUE(sink.frames[1].ended());
  EXPECT_EQ(sink.frames[1].solve().state(), v1::Solve::SUCCEEDED);
}

TEST_F(WatchTest, FinishesOnceAndOnlyWhenNothingIsUnderWay) {
  publish();
  watch.take_turn(now);
  watch.stop({grpc::CANCELLED, ""});
  watch.take_turn(now);
  EXPECT_FALSE(sink.status) << "a write is under way";
  watch.written(false);
  watch.take_turn(now);
  ASSERT_TRUE(sink.status);
  EXPECT_EQ(sink.status->error_code(), grpc::CANCELLED);
  publish();
  watch.stop({grpc::UNAVAILABLE, ""});
  watch.take_turn(now + 1s);  // the recorder fails on any further call
}

TEST_F(WatchTest, WatchersInStepShareTheBytesOfAFrame) {
  Recorder other_sink;
  Watch other(frames, {.min_interval = 100ms}, other_sink);
  publish();
  watch.take_turn(now);
  other.take_turn(now);
  EXPECT_EQ(sink.starts, other_sink.starts);
}

TEST_F(WatchTest, FramesThatWereNeverSentCannotBeAcknowledged) {
  publish();
  watch.take_turn(now);
  const auto acknowledge = [&](std::uint64_t count, std::uint64_t revision) {
    return refusal_of(grpc::INVALID_ARGUMENT, [&] { watch.acknowledge(count, revision); });
  };
  EXPECT_EQ(acknowledge(2, 1), "frame_count: 2 was not sent, the newest is 1");
  EXPECT_EQ(acknowledge(0, 1), "frame_count: 0 was not sent, the newest is 1");
  EXPECT_EQ(acknowledge(1, 9), "revision: 9 was not sent, the newest is 1");
}

}  // namespace
}  // namespace alvor
