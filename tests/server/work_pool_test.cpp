#include "server/base/work_pool.h"

#include "tests/server/refusal.h"

#include <gtest/gtest.h>

#include <latch>

namespace alvor {
namespace {

/// Makes a thread wait until the gate is opened.
struct Gate {
  std::latch begun{1}, open{1};
  void pass() {
    begun.count_down();
    open.wait();
  }
};

TEST(WorkPool, OneCallerDoesNotTakeAllThreads) {
  Gate gate;
  std::latch others(1);
  WorkPool pool({.threads = 2, .of_one = 1});
  const auto stop = std::make_shared<CallStop>();
  pool.post("ali", stop, [&] { gate.pass(); });
  gate.begun.wait();
  for (int n = 0; n < 10; ++n) pool.post("ali", stop, [] {});
  pool.post("bob", stop, [&] { others.count_down(); });
  others.wait();  // returns: bob's task runs although ali's were posted before and wait
  gate.open.count_down();
}

TEST(WorkPool, CallersTakeTurns) {
  std::vector<std::string> order;
  {
    Gate gate;
    WorkPool pool({.threads = 1, .of_one = 1});
    const auto stop = std::make_shared<CallStop>();
    pool.post("first", stop, [&] { gate.pass(); });
    gate.begun.wait();
    for (const char* caller : {"ali", "ali", "ali", "bob", "cid"})
      pool.post(caller, stop, [&order, caller] { order.push_back(caller); });
    gate.open.count_down();
  }
  EXPECT_EQ(order, (std::vector<std::string>{"ali", "bob", "cid", "ali", "ali"}));
}

TEST(WorkPool, WhatIsStoppedIsRunAllTheSameAndToldWhy) {
  WorkPool pool({.threads = 1});
  Gate gate;
  const auto running = std::make_shared<CallStop>(), waiting = std::make_shared<CallStop>(), late = std::make_shared<CallStop>();
  std::latch all(3);
  pool.post("ali", running, [&] {
    gate.pass();
    all.count_down();
  });
  pool.post("ali", waiting, [&] { all.count_down(); });
  gate.begun.wait();
  pool.stop();
  pool.post("ali", late, [&] { all.count_down(); });
  gate.open.count_down();
  all.wait();
  for (const auto& stop : {running, waiting, late}) {
    EXPECT_TRUE(stop->token().stop_requested());
    EXPECT_EQ(refusal_of(grpc::UNAVAILABLE, [&] { stop->refuse_stopped(); }), "the server is stopping");
  }
}

TEST(WorkPool, WhatTakesTooLongIsStopped) {
  WorkPool pool({.threads = 1, .time = std::chrono::seconds(0)});
  const auto stop = std::make_shared<CallStop>();
  std::latch ended(1);
  pool.post("ali", stop, [&] {
    while (!stop->token().stop_requested()) std::this_thread::yield();
    ended.count_down();
  });
  ended.wait();
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { stop->refuse_stopped(); }),
            "takes longer than 0 s, the limit of this server");
}

TEST(WorkPool, WhatWaitsOfOneCallerIsBounded) {
  Gate gate;
  std::latch others(1);
  WorkPool pool({.waiting = 2, .threads = 1});
  const auto stop = std::make_shared<CallStop>();
  pool.post("ali", stop, [&] { gate.pass(); });
  gate.begun.wait();
  for (int n = 0; n < 2; ++n) pool.post("ali", stop, [] {});
  EXPECT_EQ(refusal_of(grpc::RESOURCE_EXHAUSTED, [&] { pool.post("ali", stop, [] {}); }),
            "calls: 2 wait already, as many as are allowed");
  pool.post("bob", stop, [&] { others.count_down(); });
  gate.open.count_down();
  others.wait();
}

TEST(CallStop, TheFirstReasonCounts) {
  CallStop stop;
  EXPECT_EQ(refusal_of(grpc::CANCELLED, [&] { stop.refuse_stopped(); }), "");
  stop.stop({grpc::CANCELLED, "gone"});
  stop.stop({grpc::UNAVAILABLE, "stopping"});
  EXPECT_EQ(refusal_of(grpc::CANCELLED, [&] { stop.refuse_stopped(); }), "gone");
}

}  // namespace
}  // namespace alvor
